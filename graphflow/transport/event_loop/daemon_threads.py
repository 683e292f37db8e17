"""Daemon threads for blocking work: reused, not joined at exit, and available while the interpreter exits.

A pool of `concurrent.futures` delays the interpreter's exit until its work is done, and accepts no work from then on.
From Python 3.12 on, no thread can be started after the main thread has ended, so some are started before and reserved
for closing resources then.
"""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from queue import SimpleQueue
from typing import Any, NamedTuple, TypeVar

T = TypeVar("T")

IDLE_LIMIT = 8
"""Idle threads that wait for more work; others end."""
RESERVE = 4
"""Threads reserved for the interpreter's exit: closing a session takes two at a time."""


class _Work(NamedTuple):
    fn: Callable[[], Any]
    done: Callable[[Any, BaseException | None], object]
    name: str


class _Worker(threading.Thread):
    """A thread that executes one function after another."""

    def __init__(self, pool: ThreadPool) -> None:
        super().__init__(name="graphflow-idle", daemon=True)
        self.work: SimpleQueue[_Work] = SimpleQueue()
        self._pool = pool

    def run(self) -> None:
        stays = True
        while stays:
            fn, done, self.name = self.work.get()
            result, error = None, None
            try:
                result = fn()
            except BaseException as raised:  # passed to the caller, who handles it
                error = raised
            # Idle before the result is reported: an immediate next call reuses the thread.
            self.name = "graphflow-idle"
            stays = self._pool.is_kept(self)
            done(result, error)
            del fn, done, result, error  # not kept alive until the next work


class ThreadPool:
    """The threads of one process. A forked child starts with none."""

    def __init__(self) -> None:
        self._forget()
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._forget)

    def _forget(self) -> None:
        self._lock = threading.Lock()
        self._idle: list[_Worker] = []
        self._reserve: list[_Worker] = []

    def reserve(self) -> None:
        """Start the reserved threads, once."""
        with self._lock:
            while len(self._reserve) < RESERVE:
                self._reserve.append(self._started())

    def run(self, fn: Callable[[], T], done: Callable[[T | None, BaseException | None], object], name: str) -> _Worker:
        """Call `fn()` in a thread, and then `done(result, error)`, which must not raise, in the same thread.

        Args:
            name: The thread's name during the call.

        Raises:
            RuntimeError: A thread cannot be started.
        """
        with self._lock:
            worker = self._idle.pop() if self._idle else None
        if worker is None:
            worker = self._new()
        worker.work.put(_Work(fn, done, name))
        return worker

    def is_kept(self, worker: _Worker) -> bool:
        """Whether a worker should wait for more work."""
        with self._lock:
            if len(self._idle) >= IDLE_LIMIT:
                return False
            self._idle.append(worker)
            return True

    def _new(self) -> _Worker:
        try:
            return self._started()
        except RuntimeError:
            with self._lock:
                if threading.main_thread().is_alive() or not self._reserve:
                    raise
                return self._reserve.pop()

    def _started(self) -> _Worker:
        worker = _Worker(self)
        worker.start()
        return worker


THREADS = ThreadPool()
"""The threads of this process."""


class DaemonExecutor(ThreadPoolExecutor):
    """An executor for `asyncio.to_thread` and `run_in_executor(None, ...)` with asyncio's limit, on these threads.

    Neither closing the loop nor the interpreter's exit waits for running functions.
    """

    def __init__(self) -> None:
        # A ThreadPoolExecutor, since `loop.set_default_executor` takes nothing else; it starts no thread of its own.
        super().__init__()
        self._order = threading.Lock()
        self._free = self._max_workers
        self._waiting: deque[tuple[Future[Any], Callable[[], object]]] = deque()

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        future: Future[T] = Future()

        def work() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                result = fn(*args, **kwargs)
            except BaseException as error:  # passed to the future, whose consumer handles it
                future.set_exception(error)
            else:
                future.set_result(result)

        with self._order:
            if not self._free:
                self._waiting.append((future, work))
                return future
            self._free -= 1
        try:
            THREADS.run(lambda: self._work_off(work), lambda *_: None, f"graphflow-{getattr(fn, '__name__', 'thread')}")
        except RuntimeError:
            with self._order:
                self._free += 1
            raise
        return future

    def _work_off(self, work: Callable[[], object]) -> None:
        while True:
            work()
            with self._order:
                if not self._waiting:
                    self._free += 1
                    return
                _, work = self._waiting.popleft()

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Cancel functions that have not started."""
        with self._order:
            waiting, self._waiting = self._waiting, deque()
        for future, _ in waiting:
            future.cancel()
