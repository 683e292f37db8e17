"""Wake-ups for threads that are safe in a signal handler, which may interrupt the very thread that it wakes."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

LONGEST = 3600.0
"""Seconds of one system call's wait; a longer wait uses several."""


class Wake:
    """Wakes the waiting thread, or else the next one that waits. Python's locks are unsafe in signal handlers."""

    __slots__ = ("_queue",)

    def __init__(self) -> None:
        self._queue: queue.SimpleQueue[None] = queue.SimpleQueue()

    def set(self) -> None:
        """Wake the thread. Callable from any thread, and from signal handlers."""
        if self._queue.empty():  # a second signal before the wait would only cause a spurious wake-up
            self._queue.put(None)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait at most `timeout` seconds; return whether woken."""
        until = None if timeout is None else time.monotonic() + timeout
        while True:
            left = LONGEST if until is None else max(0.0, until - time.monotonic())
            try:
                self._queue.get(timeout=min(left, LONGEST))
            except queue.Empty:
                if left <= LONGEST and until is not None:
                    return False
            else:
                return True

    def wait_until(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Wait until `condition()` is true, checked on each wake, at most `timeout` seconds; return whether it is."""
        until = None if timeout is None else time.monotonic() + timeout
        while not condition():
            left = None if until is None else until - time.monotonic()
            if (left is not None and left <= 0) or not self.wait(left):
                return condition()
        return True


class SharedWake(Wake):
    """Wakes all threads that wait; if none does, the next one."""

    __slots__ = ("_is_taken", "_others", "_taking")

    def __init__(self) -> None:
        super().__init__()
        self._others: dict[Wake, None] = {}
        self._is_taken = False
        self._taking = threading.Lock()

    def set(self) -> None:
        super().set()
        for other in list(self._others):
            other.set()

    @contextmanager
    def for_one(self) -> Iterator[Wake]:
        """Return the wake for one thread: this one, or another if this is in use."""
        with self._taking:
            wake = Wake() if self._is_taken else self  # a queue wakes only one of the threads that wait on it
            self._is_taken = True
            if wake is not self:
                self._others[wake] = None
        try:
            yield wake
        finally:
            if wake is self:
                self._is_taken = False
            else:
                del self._others[wake]
