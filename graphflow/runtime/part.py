"""What a node's parts need from it, and what it needs from its parts."""

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
from graphflow.runtime.mistakes.rclpy_words import SpeaksRos


class Host(Protocol):
    """A node as its publishers, services, timers and the like see it."""

    @property
    def id(self) -> int:
        """The node's number in the process, once it runs."""

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
        """The context that the node runs in. Raises ClosedError when it does not run."""

    @property
    def clock(self) -> Clock:
        """The clock for its timers, sleeps and deadlines. Raises ClosedError when the node does not run."""

    def serves(self, service: str) -> bool:
        """Whether a service of that full name is the node's own."""

    def runner(self, spec: RunnerSpec, items: deque[Any], group: HandlerGroup | None = None) -> Runner:
        """A runner for one of its handlers; without a group it queues behind itself only."""

    def forget(self, part: Part) -> None:
        """Remove a closed part from the list."""

    def handler_failed(self, label: str, error: BaseException, on_error: OnError | None = None) -> None:
        """Report an error in a handler and what it means for the node; None where a caller gets the error."""

    def report_error(self, label: str, error: BaseException) -> None:
        """Log an error: graphflow's own as a sentence, any other with its traceback."""


class Part(SpeaksRos, ABC):
    """What a node opens, stops and closes: an endpoint, an action, a timer."""

    opens_last = False
    """Whether the part must open after everything else, because it begins work by itself."""
    is_inner = False
    """Whether the part belongs to graphflow, as every node's parameter services do."""
    idle_because = ""
    """Why the part does no work though it is on the network; empty while it does."""

    @property
    def title(self) -> str:
        """The part's kind and name; empty for a part without statistics."""
        return ""

    @property
    def handler_title(self) -> str:
        """Kind and handler of what the part runs: `service add`; empty if it runs nothing."""
        return ""

    @property
    def endpoints(self) -> Sequence[Any]:
        """What the part has on the network, as `Endpoint`."""
        return ()

    def statistics(self) -> dict[str, Any]:
        """Numbers since the start."""
        return {}

    def complaints(self) -> list[str]:
        """What is wrong with the part that it knows itself, a sentence for each."""
        return []

    @abstractmethod
    def open(self) -> None:
        """Begin. Called by the node."""

    def begin_to_stop(self) -> Runner | None:
        """Begin no more work; returns the runner of its handler, whose runs are then cancelled and waited for."""
        return None

    def pause(self, why: str) -> Runner | None:
        """Stay on the network, but do nothing until `resume`; returns the runner whose runs are to be cancelled."""
        self.idle_because = why
        return None

    def resume(self) -> Runner | None:
        """Do again what the part is for; returns its runner, which begins runs again."""
        self.idle_because = ""
        return None

    @abstractmethod
    def close(self) -> None:
        """Withdraw the part from the network. Closing twice is harmless."""

    def clock_changed(self) -> None:
        """The node has switched to another clock."""
