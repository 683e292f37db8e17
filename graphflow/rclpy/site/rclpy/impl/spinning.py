"""The work of an executor: its tasks, and the callbacks of its nodes' entities."""

from __future__ import annotations

import threading
import time
import weakref
from collections import deque
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Protocol

from graphflow.rclpy.wake import SharedWake
from rclpy.exceptions import InvalidHandle
from rclpy.impl.nodes import internals_of
from rclpy.task import Task

if TYPE_CHECKING:
    from rclpy.callback_groups import CallbackGroup
    from rclpy.context import Context
    from rclpy.node import Node

POLL = 0.001
"""Seconds between two steps of a coroutine that yields without naming a future."""


class TimeoutException(Exception):
    """Nothing became ready in time."""


class ShutdownException(Exception):
    """The executor was shut down."""


class ExternalShutdownException(Exception):
    """The context was shut down while an executor was spinning."""


class ConditionReachedException(Exception):
    """The awaited condition has become true."""


for _kind in (TimeoutException, ShutdownException, ExternalShutdownException, ConditionReachedException):
    # Where rclpy defines them: so they are named in tracebacks.
    _kind.__module__ = "rclpy.executors"


class Entity(Protocol):
    """An object with callbacks, such as a timer or subscription."""

    @property
    def callback_group(self) -> Any: ...

    def has_work(self) -> bool:
        """Whether there is work to take."""

    def take_work(self) -> Callable[[], object] | None:
        """Take one piece of work: a function or coroutine function."""


class Spins(Protocol):
    """An executor, as its own implementation sees it."""

    @property
    def spinning(self) -> Spinning: ...

    def can_execute(self, entity: Entity) -> bool: ...

    def create_task(self, callback: Any, *args: Any) -> Any: ...


class Run(Task):
    """A task, or one run of a callback, which holds a place in its group until it has ended.

    Attributes:
        called: The function that it runs.
        entity, node: The owners of the callback; None for tasks.
        thread: The identity of the thread that runs it; 0 while none does.
    """

    def __init__(
        self, executor: Spins, handler: Any, args: tuple[Any, ...] = (), kwargs: dict[str, object] | None = None
    ) -> None:
        super().__init__(handler, args, kwargs, executor=executor)
        self.executor, self.called = executor, handler
        self.entity: Entity | None = None
        self.node: Node | None = None
        self.group: CallbackGroup | None = None
        self.thread = 0
        self.stepped_ns = 0
        self.work: object = None
        """The work taken from the entity."""

    @property
    def args(self) -> tuple[Any, ...]:
        """The arguments of the function; empty once it has ended."""
        return self._args

    @property
    def coroutine(self) -> Any:
        """The coroutine that it steps; None for a plain function, and once it has ended."""
        return self._coroutine

    def _step(self) -> None:
        self.thread = threading.get_ident()
        try:
            super()._step()
        finally:
            self.thread = 0

    def _stepped(self) -> None:
        self.stepped_ns = time.monotonic_ns()
        self.executor.spinning.stepped(self)

    def cancel(self) -> None:
        super().cancel()
        # Else the thread that is stepping it calls `stepped` afterwards.
        if not self.executing():
            self.executor.spinning.stepped(self)

    def ended(self) -> bool:
        return self.done() or self.cancelled()

    def release(self) -> None:
        """Release the place in the group. Idempotent."""
        group, self.group = self.group, None
        if group is not None:
            group.ending_execution(self.entity)


STEP = Run._step.__code__
"""The code of a frame that runs a step."""


class Spinning:
    """The scheduling behind an executor, hidden from subclasses."""

    def __init__(self, executor: Spins, context: Context) -> None:
        self._executor, self.context = weakref.ref(executor), context
        self.wake = SharedWake()
        self.nodes: dict[Node, None] = {}
        self.is_shutdown = False
        self.running: dict[Run, None] = {}
        """Tasks and runs of callbacks that have not ended, including suspended ones."""
        self._runnable: deque[Run] = deque()
        self._polled: deque[Run] = deque()
        self._round: deque[tuple[Any, Any]] = deque()
        """Entities found to have work, with their nodes; tasks have none."""
        self._tasks_were_last = False
        self._asking: list[tuple[float | None, object, Callable[[], bool]]] = []
        """The arguments with which each waiting thread requested its next work."""
        self.turns = 0
        """The number of requests for work."""
        self._looking = threading.Lock()
        self.threads = 1
        """The number of threads that run callbacks."""
        self.has_room: Callable[[], bool] = lambda: True
        self.has_failed: Callable[[], bool] = lambda: False

    @property
    def executor(self) -> Spins:
        """The executor that this belongs to; a weak reference, since programs check whether it still exists."""
        executor = self._executor()
        assert executor is not None
        return executor

    @property
    def is_spun(self) -> bool:
        """Whether a thread waits for work, or does some."""
        return bool(self._asking) or any(run.thread for run in list(self.running))

    @property
    def waits_forever(self) -> bool:
        """Whether a thread waits for work without a limit."""
        return any(timeout is None or timeout < 0 for timeout, _, _ in list(self._asking))

    # tasks

    def start(self, run: Run) -> None:
        """Schedule a task to start or continue in the next turn."""
        self.running[run] = None
        self._runnable.append(run)
        self.wake.set()

    def stepped(self, run: Run) -> None:
        """Note that a run has made a step: it has ended, or waits for something."""
        if run.ended():
            self.running.pop(run, None)
            run.release()
            self.wake.set()
        elif run.awaits is None:
            self._polled.append(run)
            self.wake.set()
        else:
            run.awaits.when_done(lambda: self.start(run))

    # what is next

    def _count_turn(self) -> None:
        """Count a request before anything can raise: watches see by it that somebody spins."""
        for node in () if self.turns else self.nodes:
            internals_of(node).was_spun = True
        self.turns += 1

    def next(
        self, timeout: float | None, nodes: Iterable[Node] | None, condition: Callable[[], bool]
    ) -> tuple[Run, Entity | None, Node | None]:
        """Return the next piece of work with its entity and node, waiting for one if necessary.

        Raises:
            ShutdownException, ExternalShutdownException, ConditionReachedException, TimeoutException: See there.
            ValueError: Another thread waits with the same arguments, which ROS 2 refuses; with others it may.
        """
        self._count_turn()
        asked = (timeout, nodes, condition)
        # In rclpy the threads share one generator as long as their arguments are equal. Here only its refusal is kept.
        if asked in self._asking:
            raise ValueError("generator already executing")
        until = None if timeout is None or timeout < 0 else time.monotonic() + timeout
        life = self.context.life
        if life is not None:
            life.on_end(self.wake)
        self._asking.append(asked)
        try:
            # A wake per thread: what one of them waits for must not be swallowed by the other.
            with self.wake.for_one() as wake:
                while True:
                    if self.is_shutdown:
                        raise ShutdownException
                    if not self.context.ok():
                        if life is not None:
                            life.end_daemon()
                        raise ExternalShutdownException
                    if condition() or self.has_failed():
                        raise ConditionReachedException
                    found = self._find(nodes, is_hurried=timeout == 0)
                    if found is not None:
                        return found
                    left = None if until is None else until - time.monotonic()
                    if left is not None and left <= 0:
                        raise TimeoutException
                    wake.wait(_shorter(left, self._next_timer(nodes) if self.has_room() else None))
        finally:
            self._asking.remove(asked)

    def _find(self, nodes: Iterable[Node] | None, *, is_hurried: bool) -> tuple[Run, Entity | None, Node | None] | None:
        # One thread at a time: rounds, and what is taken from them, are shared.
        with self._looking:
            return self._found(nodes, is_hurried=is_hurried) if self.has_room() else None

    def _found(
        self, nodes: Iterable[Node] | None, *, is_hurried: bool
    ) -> tuple[Run, Entity | None, Node | None] | None:
        for _ in range(3):  # what the last check found, then new tasks, then new arrivals
            while self._round:
                what, node = self._round.popleft()
                found = what if isinstance(what, Run) else self._begin(what, node)
                if found is not None and not found.ended():
                    return found, found.entity, found.node
            self._fill_round(nodes, is_hurried=is_hurried)
        return None

    def _fill_round(self, nodes: Iterable[Node] | None, *, is_hurried: bool) -> None:
        """Fill the round: tasks, newest first, then timers, and arrivals by kind."""
        now_ns = time.monotonic_ns()
        for _ in range(len(self._polled)):
            # A bare `yield`, as of `asyncio.sleep(0)`, names no future: stepped at intervals, not in a busy loop.
            run = self._polled.popleft()
            is_due = is_hurried or now_ns - run.stepped_ns >= POLL * 1e9
            (self._runnable if is_due else self._polled).append(run)
        if self._runnable and not self._tasks_were_last:  # their effects come before earlier arrivals
            self._tasks_were_last = True
            while self._runnable:
                # From the end: Jazzy goes through its tasks in reverse; versions after it do not.
                self._round.append((self._runnable.pop(), None))
            return
        self._tasks_were_last = False
        chosen = list(self.nodes) if nodes is None else list(nodes)
        # Timers are looked up, since time makes them ready; all else has announced itself to the node's bell.
        for node in chosen:
            self._round.extend((timer, node) for timer in list(node.timers) if timer.has_work())
        for node in chosen:
            bell = internals_of(node).bell
            bell.attend()
            ready = bell.ready
            for waitable in list(node.waitables):
                # Waitables of a program's own know no bell.
                if waitable not in ready and waitable.has_work():
                    ready[waitable] = None
            for entity in sorted(ready, key=_order):
                if entity.has_work():
                    self._round.append((entity, node))
                else:
                    del ready[entity]

    def _begin(self, entity: Entity, node: Node) -> Run | None:
        """Take a piece of work, and reserve a place in its group; None if there is none."""
        # Removed since the round was filled. Without any nodes, they came as an argument of `wait_for_ready_callbacks`.
        if node not in self.nodes and self.nodes:
            return None
        group = entity.callback_group
        try:
            # Both, as in rclpy: groups and executors of a program's own may override either.
            if not self.executor.can_execute(entity) or not group.beginning_execution(entity):
                return None
            work = entity.take_work()
        except InvalidHandle:
            work = None
        # The place was reserved for nothing: what was seen may have been taken since.
        if work is None:
            group.ending_execution(entity)
            return None
        run = Run(self.executor, work)
        run.entity, run.node, run.group, run.work = entity, node, group, work
        self.running[run] = None
        return run

    def _next_timer(self, nodes: Iterable[Node] | None) -> float | None:
        """Return the seconds until a timer is due by this machine's clock."""
        soonest: float | None = POLL if self._polled else None
        for node in list(self.nodes) if nodes is None else list(nodes):
            for timer in list(node.timers):
                left = timer.seconds_left()
                if left is not None and (soonest is None or left < soonest) and self.executor.can_execute(timer):
                    soonest = max(0.0, left)
        return soonest


def _shorter(a: float | None, b: float | None) -> float | None:
    return b if a is None else a if b is None else min(a, b)


def _order(entity: Entity) -> int:
    """Return an entity's rank in a round: subscriptions, guard conditions, clients, services, then the rest."""
    return getattr(type(entity), "turn", 9)
