"""The ledger of a process: the calls, goals and threads that handlers wait for, and the handler on the loop.

It is updated as waits start and end, with an entry per wait and none per message, by a `with` block:

    with ledger.call(future, gid, sequence, "/add", began_ns, deadline_ns):
        await future

The deadlock search reads it, from any thread. Entries are keyed by the awaited future, which is all that a suspended
coroutine reveals of its wait.
"""

from __future__ import annotations

import asyncio
import threading
from abc import ABC, abstractmethod
from asyncio import AbstractEventLoop, Future
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, Self

from graphflow.machines.waits.wait_graph import call_id


class PendingCall:
    """A service call that waits for its response. A context manager that enters the call in the ledger.

    Attributes:
        gid, sequence: The client's GID and sequence number, which together identify the call in all processes.
        service: The full name of the service.
        began_ns, deadline_ns: Times by the clock of the client's node; the deadline may be None.
    """

    __slots__ = ("_future", "_ledger", "began_ns", "deadline_ns", "gid", "sequence", "service")

    def __init__(
        self,
        ledger: Ledger,
        future: Future[Any],
        gid: bytes,
        sequence: int,
        service: str,
        began_ns: int,
        deadline_ns: int | None,
    ) -> None:
        self._ledger, self._future = ledger, future
        self.gid, self.sequence, self.service = gid, sequence, service
        self.began_ns, self.deadline_ns = began_ns, deadline_ns

    @property
    def id(self) -> str:
        """The call's id in the wait-for graphs of all processes."""
        return call_id(self.gid, self.sequence)

    def __enter__(self) -> Self:
        self._ledger.calls[self._future] = self
        self._ledger.alert()
        return self

    def __exit__(self, *_: object) -> None:
        self._ledger.calls.pop(self._future, None)


class PendingGoal(ABC):
    """A goal sent by this process that has not ended.

    Attributes:
        goal_id: 16 bytes.
        action: The full name of the action.
        began_ns: Time of sending, by the process's clock.
        ended: A future that is done when the goal has ended.
    """

    goal_id: bytes
    action: str
    began_ns: int
    ended: Future[Any]

    @property
    @abstractmethod
    def done(self) -> bool:
        """Whether the goal has ended."""


class Opening(NamedTuple):
    """A wait for a node to offer a service."""

    service: str
    began_ns: int
    """Start of the wait, by the clock of the client's node."""


class AwaitedTransform(NamedTuple):
    """A transform that is awaited, and what it lacks."""

    what: str
    """A description: `the transform map -> base_link`."""
    frames: tuple[str, ...] = ()
    """Frames that no transform has named or connected yet."""
    node: str = ""
    """The node that has sent the transform, if the latest is too old."""


def _nothing() -> None:
    """Do nothing: the deadlock search is off."""


class Ledger:
    """The waits of one process.

    Attributes:
        alert: Called at the start of a wait: a call, or work without a free slot. Must be cheap.
        at_work: The runner whose handler is executing and has not suspended.
    """

    __slots__ = (
        "alert",
        "asking",
        "at_work",
        "blocking",
        "calls",
        "goals",
        "loop",
        "openings",
        "served",
        "thread",
        "threads",
        "transforms",
    )

    def __init__(self, loop: AbstractEventLoop) -> None:
        self.loop = loop
        self.thread = threading.get_ident()
        """The event loop's thread."""
        self.alert: Callable[[], None] = _nothing
        self.at_work: object = None
        self.calls: dict[Future[Any], PendingCall] = {}
        """Calls, by the future of the response."""
        self.goals: dict[Future[Any], PendingGoal] = {}
        """Goals that are awaited, by the future of their end or of news about them."""
        self.served: dict[Future[Any], bytes] = {}
        """Ids of goals of this process whose results are awaited."""
        self.openings: dict[Future[Any], Opening] = {}
        """Services that are awaited until a node offers them."""
        self.transforms: dict[Future[Any], Callable[[], AwaitedTransform]] = {}
        """Transforms that are awaited, each as a function that says what it lacks now."""
        self.threads: dict[Future[Any], threading.Thread] = {}
        """Threads that are awaited."""
        self.asking: dict[int, asyncio.Task[Any]] = {}
        """Calls that threads wait for, by the thread's id."""
        self.blocking: Future[Any] | None = None
        """The future of a call that blocks the event loop."""

    def call(
        self,
        future: Future[Any],
        gid: bytes,
        sequence: int,
        service: str,
        began_ns: int,
        deadline_ns: int | None,
    ) -> PendingCall:
        """Return a call whose response `future` waits for, to be entered with `with`."""
        return PendingCall(self, future, gid, sequence, service, began_ns, deadline_ns)

    @contextmanager
    def goal(self, future: Future[Any], goal: PendingGoal) -> Iterator[None]:
        """Enter a wait for the end of a goal, or for news about it."""
        self.goals[future] = goal
        try:
            yield
        finally:
            del self.goals[future]

    @contextmanager
    def serving(self, future: Future[Any], goal_id: bytes) -> Iterator[None]:
        """Enter this process's own wait for the end of a goal that it executes, to report its result."""
        self.served[future] = goal_id
        try:
            yield
        finally:
            del self.served[future]

    @contextmanager
    def opening(self, future: Future[Any], service: str, began_ns: int) -> Iterator[None]:
        """Enter a wait for a node to offer a service."""
        self.openings[future] = Opening(service, began_ns)
        self.alert()
        try:
            yield
        finally:
            del self.openings[future]

    @contextmanager
    def transform(self, future: Future[Any], awaited: Callable[[], AwaitedTransform]) -> Iterator[None]:
        """Enter a wait for a transform."""
        self.transforms[future] = awaited
        self.alert()
        try:
            yield
        finally:
            del self.transforms[future]

    @contextmanager
    def thread_work(self, future: Future[Any], thread: threading.Thread) -> Iterator[None]:
        """Enter a wait for a thread's end."""
        self.threads[future] = thread
        try:
            yield
        finally:
            del self.threads[future]

    @contextmanager
    def asked_from(self, thread: int, task: asyncio.Task[Any]) -> Iterator[None]:
        """Enter a thread's wait for the response to a task on the loop."""
        self.asking[thread] = task
        try:
            yield
        finally:
            del self.asking[thread]

    @contextmanager
    def blocked_by(self, future: Future[Any]) -> Iterator[None]:
        """Enter the event loop's own wait for a future, which cannot complete meanwhile."""
        self.blocking = future
        try:
            yield
        finally:
            self.blocking = None
