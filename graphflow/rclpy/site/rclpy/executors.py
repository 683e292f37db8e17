"""Executors, whose threads run the callbacks of nodes."""

from __future__ import annotations

import inspect
import os
import threading
import time
import warnings
from collections import deque
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any, Self
from weakref import WeakSet

from rclpy.impl.mistakes.spin_arguments import check_node, is_node, warn_no_node
from rclpy.impl.mistakes.swallowed_errors import Spin
from rclpy.impl.nodes import internals_of
from rclpy.impl.reexports import passed_on
from rclpy.impl.spinning import (
    POLL,
    ConditionReachedException,
    ExternalShutdownException,
    Run,
    ShutdownException,
    Spinning,
    TimeoutException,
)
from rclpy.task import Future, Task
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.impl.spinning import Entity
    from rclpy.node import Node

__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
    "TimeoutObject",
    "await_or_execute",
]

all_executors: WeakSet[Executor] = WeakSet()
"""The executors of this process, for the deadlock detector."""


class TimeoutObject:
    """A time limit in seconds, shared by several calls."""

    def __init__(self, timeout: float) -> None:
        self._timeout = timeout

    @property
    def timeout(self) -> float:
        return self._timeout

    @timeout.setter
    def timeout(self, timeout: float) -> None:
        self._timeout = timeout


async def await_or_execute(callback: Any, *args: Any) -> Any:
    """Call `callback(*args)`, and await the result if it is a coroutine function."""
    return await callback(*args) if inspect.iscoroutinefunction(callback) else callback(*args)


class Executor(AbstractContextManager["Executor"]):
    """The base class of executors. A subclass's `spin_once` chooses the thread that does the work."""

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__()
        self._context = get_default_context() if context is None else context
        # A name that nobody writes: programs derive from executors, and have attributes of their own.
        self._graphflow = Spinning(self, self._context)
        self._graphflow_watched: WeakSet[object] = WeakSet()
        all_executors.add(self)

    @property
    def context(self) -> Context:
        return self._context

    @property
    def spinning(self) -> Spinning:
        """graphflow's implementation of the spinning."""
        return self._graphflow

    @property
    def _is_shutdown(self) -> bool:
        return self._graphflow.is_shutdown

    @_is_shutdown.setter
    def _is_shutdown(self, value: bool) -> None:
        self._graphflow.is_shutdown = value

    def create_task(self, callback: Any, *args: Any, **kwargs: object) -> Task:
        """Run a function, a coroutine function or a coroutine as a task; return the task."""
        run = Run(self, callback, args, kwargs)
        self._graphflow.start(run)
        return run

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Start no more work.

        Args:
            timeout_sec: Seconds to wait for callbacks that run in other threads; None for not waiting.

        Returns:
            Whether none is running any more.
        """
        spinning = self._graphflow
        spinning.is_shutdown = True
        spinning.wake.set()
        # A callback may shut its own executor down, and would wait for itself.
        me, until = threading.get_ident(), time.monotonic() + (timeout_sec or 0.0)
        while others := [run for run in list(spinning.running) if run.thread not in (0, me)]:
            if timeout_sec is not None and timeout_sec >= 0 and time.monotonic() >= until:
                return False
            # rclpy documents None as "block forever", but Jazzy sets its flag before it tests it, and never waits.
            if timeout_sec is None:
                break
            time.sleep(POLL)
        for node in list(spinning.nodes):
            self.remove_node(node)
        return not others

    def __del__(self) -> None:
        # `__init__` of a subclass may have failed before it called this class's.
        spinning = getattr(self, "_graphflow", None)
        if spinning is not None:
            spinning.is_shutdown = True

    def add_node(self, node: Node) -> bool:
        """Run a node's callbacks from now on; return whether the node was new. Raises TypeError if it is not a node."""
        check_node(node, "add_node")
        spinning = self._graphflow
        if node in spinning.nodes:
            return False
        # First, since setting `node.executor` calls this method again, which ends there.
        spinning.nodes[node] = None
        node.executor = self
        inner = internals_of(node)
        inner.times_added += 1
        inner.was_spun = inner.was_spun or spinning.turns > 0
        spinning.wake.set()
        return True

    def remove_node(self, node: Node) -> None:
        """Stop running a node's callbacks."""
        if not is_node(node):
            warn_no_node("remove_node", node)
        if self._graphflow.nodes.pop(node, self) is None:
            self._graphflow.wake.set()

    def wake(self) -> None:
        """Wake the waiting thread to check for work. Callable from any thread."""
        self._graphflow.wake.set()

    def get_nodes(self) -> list[Node]:
        """Return the nodes whose callbacks it runs."""
        return list(self._graphflow.nodes)

    def spin(self) -> None:
        """Run callbacks until the context or this executor is shut down."""
        with Spin(self._context):
            while self._context.ok() and not self._graphflow.is_shutdown:
                self.spin_once()

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done, at most `timeout_sec` seconds."""
        self._graphflow_wake_when_done(future)
        if timeout_sec is None or timeout_sec < 0:
            while self._graphflow_may_go_on(future):
                self.spin_once_until_future_complete(future, timeout_sec)
            return
        until = time.monotonic() + timeout_sec
        limit = TimeoutObject(timeout_sec)
        while self._graphflow_may_go_on(future):
            self.spin_once_until_future_complete(future, limit)
            limit.timeout = until - time.monotonic()
            if limit.timeout <= 0:
                return

    def _graphflow_wake_when_done(self, future: Future) -> None:
        """Wake the executor when a future, also one of asyncio's, is done; registered once per future."""
        # Called once per turn of a loop: `add_done_callback` would collect a callback each time.
        if isinstance(future, Future):
            future.when_done(self.wake)
        elif future not in self._graphflow_watched:
            self._graphflow_watched.add(future)
            future.add_done_callback(lambda _: self.wake())

    def _graphflow_may_go_on(self, future: Future) -> bool:
        is_over = future.done() or future.cancelled()
        return self._context.ok() and not is_over and not self._graphflow.is_shutdown

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for a ready callback and run it. Subclasses implement it.

        Args:
            timeout_sec: Seconds to wait for one; None or a negative number for no limit.

        Raises:
            Exception: Any error that the callback raises.
            ExternalShutdownException: The context was shut down.
        """
        raise NotImplementedError

    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | TimeoutObject | None = None) -> None:
        """Like `spin_once`, but stop waiting when a future is done."""
        raise NotImplementedError

    def can_execute(self, entity: Entity) -> bool:
        """Whether an entity's group allows its callback to run now."""
        return bool(entity.callback_group.can_execute(entity))

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: list[Node] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task, Entity | None, Node | None]:
        """Wait for work: return a task to call, its entity and its node.

        Raises:
            TimeoutException: Nothing was ready in time.
            ShutdownException: The executor was shut down.
            ExternalShutdownException: The context was shut down.
            ConditionReachedException: `condition()` is true.
        """
        timeout = timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec
        return self._graphflow.next(timeout, nodes, condition)

    # A generator, as in rclpy, where `wait_for_ready_callbacks` steps it.
    def _wait_for_ready_callbacks(
        self, *args: Any, **kwargs: Any
    ) -> Generator[tuple[Task, Entity | None, Node | None], None, None]:
        while True:
            yield self.wait_for_ready_callbacks(*args, **kwargs)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()


_NOTHING_TO_DO = (ShutdownException, TimeoutException, ConditionReachedException)


class SingleThreadedExecutor(Executor):
    """An executor that runs callbacks one at a time in the spinning thread."""

    def _graphflow_do_one(
        self, timeout: float | TimeoutObject | None, condition: Callable[[], bool] = lambda: False
    ) -> None:
        try:
            handler, _, _ = self.wait_for_ready_callbacks(timeout, None, condition)
        except _NOTHING_TO_DO:
            return
        handler()
        error = handler.exception()
        if error is not None:
            raise error

    def spin_once(self, timeout_sec: float | None = None) -> None:
        self._graphflow_do_one(timeout_sec)

    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | TimeoutObject | None = None) -> None:
        self._graphflow_wake_when_done(future)
        self._graphflow_do_one(timeout_sec, lambda: future.done() or future.cancelled())


class _Pool:
    """A pool of daemon threads that end with the process, even in the middle of work."""

    def __init__(self, size: int, freed: Callable[[], None]) -> None:
        self._max_workers = size
        self._freed = freed
        self._graphflow_work: deque[Callable[[], None]] = deque()
        self._there = threading.Semaphore(0)
        self._lock = threading.Lock()
        self._threads = self._busy = 0

    @property
    def has_room(self) -> bool:
        return self._busy < self._max_workers

    def submit(self, work: Callable[[], None]) -> None:
        with self._lock:
            self._busy += 1
            self._graphflow_work.append(work)
            # Threads start on demand, as in ThreadPoolExecutor: the default size is the number of processors.
            is_new = self._threads < min(self._busy, self._max_workers)
            self._threads += is_new
            number = self._threads
        if is_new:
            threading.Thread(target=self._serve, name=f"executor-{number}", daemon=True).start()
        self._there.release()

    def _serve(self) -> None:
        while True:
            self._there.acquire()
            work = self._graphflow_work.popleft()
            try:
                work()
            finally:
                # Before the thread waits: else it keeps the last callback, and thereby its node, alive.
                del work
                with self._lock:
                    self._busy -= 1
                self._freed()


class MultiThreadedExecutor(Executor):
    """An executor that runs callbacks in a pool of threads, in parallel as far as groups allow.

    Args:
        num_threads: None for the number of processors.
    """

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        if num_threads is None:
            # In a container, fewer processors than `cpu_count` may be usable. macOS and Windows have no affinity.
            affinity = getattr(os, "sched_getaffinity", None)
            num_threads = len(affinity(0)) if affinity is not None else os.cpu_count() or 2
        if not isinstance(num_threads, int):
            fault = f"num_threads must be a number of threads, got {num_threads!r}"
            raise TypeError(f"{fault}: add nodes with executor.add_node(node)")
        if num_threads == 1:
            warnings.warn(
                "MultiThreadedExecutor is used with a single thread.\nUse the SingleThreadedExecutor instead.",
                stacklevel=2,
            )
        # `_executor` and its `_max_workers` are rclpy's names, which programs read.
        self._executor = pool = _Pool(num_threads, self._graphflow.wake.set)
        self._graphflow.threads = num_threads
        self._graphflow_failures = failures = deque[BaseException]()
        # Work is taken only for a free thread, so that arrivals wait in the subscription's queue, and its depth counts.
        self._graphflow.has_room = lambda: pool.has_room
        self._graphflow.has_failed = lambda: bool(failures)

    def _graphflow_do_one(
        self, timeout: float | TimeoutObject | None, condition: Callable[[], bool] = lambda: False
    ) -> None:
        try:
            handler, _, _ = self.wait_for_ready_callbacks(timeout, None, condition)
        except (*_NOTHING_TO_DO, ExternalShutdownException):  # which here only ends the spinning
            pass
        else:
            self._executor.submit(lambda: self._graphflow_work(handler))
        try:
            error = self._graphflow_failures.popleft()
        except IndexError:  # none, or another thread has it
            return
        raise error

    # Errors of the pool are raised at once, not at the next callback as in rclpy.
    def _graphflow_work(self, handler: Task) -> None:
        try:
            handler()
            error = handler.exception()
        except BaseException as leaving:  # SystemExit and others: the spinning thread re-raises them
            error = leaving
        if error is not None:
            self._graphflow_failures.append(error)
            self.wake()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        self._graphflow_do_one(timeout_sec)

    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | TimeoutObject | None = None) -> None:
        self._graphflow_wake_when_done(future)
        self._graphflow_do_one(timeout_sec, lambda: future.done() or future.cancelled())


SPINS = (
    SingleThreadedExecutor._graphflow_do_one.__code__,
    MultiThreadedExecutor._graphflow_do_one.__code__,
    Executor.spin_until_future_complete.__code__,
)
"""The codes of frames that spin an executor, for the deadlock detector."""


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
