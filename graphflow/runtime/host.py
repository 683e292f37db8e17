"""What the parts of a node need of it, and what a node needs of its parts."""

from __future__ import annotations

import logging
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Sequence
from typing import Any, Protocol

from graphflow.executor.clock import Clock
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.interface import OnError
from graphflow.runtime.context import Context


class Host(Protocol):
    """A node, as its publishers, services, timers and the like see it."""

    @property
    def id(self) -> int:
        """Its number in the process, once it runs."""

    @property
    def name(self) -> str: ...

    @property
    def namespace(self) -> str: ...

    @property
    def full_name(self) -> str: ...

    @property
    def log(self) -> logging.Logger: ...

    @property
    def is_running(self) -> bool: ...

    @property
    def context(self) -> Context:
        """Where it runs. Raises ClosedError when it does not."""

    @property
    def clock(self) -> Clock:
        """The clock that its timers, sleeps and deadlines go by. Raises ClosedError when it does not run."""

    def serves(self, service: str) -> bool:
        """Whether a service of that full name is its own."""

    def runner(self, spec: RunnerSpec, items: deque[Any], group: HandlerGroup | None = None) -> Runner:
        """A runner for one of its handlers; without a group it queues behind itself only."""

    def forget(self, part: Part) -> None:
        """Take a part that was closed off the list."""

    def handler_failed(self, label: str, error: BaseException, on_error: OnError | None = None) -> None:
        """Tell of an error of a handler, and what it means for the node; None where a caller has the error."""

    def report_error(self, label: str, error: BaseException) -> None:
        """Log an error: one of graphflow's own is a sentence, any other comes with its traceback."""


class Part(ABC):
    """What a node opens, stops and closes: an endpoint, an action, a timer."""

    opens_last = False
    """Whether it is to open when everything else is there, as what begins work by itself."""

    @property
    def title(self) -> str:
        """What it is and its name; empty for what has no statistics."""
        return ""

    @property
    def endpoints(self) -> Sequence[Any]:
        """What it has on the network, as `Endpoint`."""
        return ()

    def statistics(self) -> dict[str, Any]:
        """Numbers since the start."""
        return {}

    @abstractmethod
    def open(self) -> None:
        """Begin. Done by the node."""

    def begin_to_stop(self) -> Runner | None:
        """Begin no more work; returns what runs its handler, whose runs are then cancelled and waited for."""
        return None

    @abstractmethod
    def close(self) -> None:
        """Withdraw it from the network. Closing twice is harmless."""

    def clock_changed(self) -> None:  # noqa: B027 - most parts go by no clock
        """The node goes by another clock."""
