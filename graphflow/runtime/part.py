"""The interface between a node and its parts."""

from __future__ import annotations

import logging
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Sequence
from typing import Any, Protocol

from graphflow.errors import Place
from graphflow.executor.clock import Clock
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.interface import OnError
from graphflow.runtime.context import Context
from graphflow.runtime.mistakes.rclpy_words import AttributeHints


class Host(Protocol):
    """A node as its parts see it."""

    @property
    def id(self) -> int:
        """The node's number in the process; 0 until it runs."""

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
        """The context of the node. Raises ClosedError when it is not running."""

    @property
    def clock(self) -> Clock:
        """The clock for timers, sleeps and deadlines. Raises ClosedError when the node is not running."""

    def serves(self, service: str) -> bool:
        """Whether the node offers the service of that full name."""

    def single_sends(self, publisher: Part) -> Sequence[Place]:
        """Return the lines at which the node's source publishes with a publisher, if each runs at most once."""

    def runner(self, spec: RunnerSpec, items: deque[Any], group: HandlerGroup | None = None) -> Runner:
        """Make a runner for a handler; without a group its runs queue only behind each other."""

    def forget(self, part: Part) -> None:
        """Remove a closed part from the node."""

    def handler_failed(self, label: str, error: BaseException, on_error: OnError | None = None) -> None:
        """Report an error in a handler and apply its policy; None if the caller receives the error."""

    def report_error(self, label: str, error: BaseException) -> None:
        """Log an error: graphflow's own as a sentence, any other with its traceback."""


class Part(AttributeHints, ABC):
    """A resource that a node opens, stops and closes: an endpoint, an action, a timer."""

    opens_last = False
    """Whether the part opens after all others, because it starts work by itself."""
    is_inner = False
    """Whether the part belongs to graphflow, such as a node's parameter services."""
    idle_because = ""
    """The reason why the part does no work while on the network; "" while it works."""

    @property
    def title(self) -> str:
        """The part's kind and name; empty for a part without statistics."""
        return ""

    @property
    def handler_title(self) -> str:
        """Kind and handler of the part: `service add`; "" without a handler."""
        return ""

    @property
    def calls(self) -> tuple[object, ...]:
        """The callback, and the topic or the period of its calls; () without a callback."""
        return ()

    @property
    def endpoints(self) -> Sequence[Any]:
        """The part's endpoints."""
        return ()

    def statistics(self) -> dict[str, object]:
        """Return counters since the start."""
        return {}

    def complaints(self) -> list[str]:
        """Return the problems that the part knows of, a sentence each."""
        return []

    @abstractmethod
    def open(self) -> None:
        """Open the part. Called by the node."""

    def begin_to_stop(self) -> Runner | None:
        """Start no more work; returns the handler's runner, which the node then cancels and waits for."""
        return None

    def pause(self, why: str) -> Runner | None:
        """Do no work until `resume`, but stay on the network; returns the runner whose runs must be cancelled."""
        self.idle_because = why
        return None

    def resume(self) -> Runner | None:
        """Resume work; returns the runner, which starts runs again."""
        self.idle_because = ""
        return None

    @abstractmethod
    def close(self) -> None:
        """Withdraw the part from the network. Closing twice is harmless."""

    def clock_changed(self) -> None:
        """Adapt to the node's new clock."""
