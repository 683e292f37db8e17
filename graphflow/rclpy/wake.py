"""Waking threads, also from a signal handler, which may interrupt the very thread that it wakes."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

LONGEST = 3600.0
"""Seconds of one wait of a system call; a longer wait is several."""


class Wake:
    """Wakes the thread that waits, or the next one that does. Locks of Python's would not bear a signal handler."""

    __slots__ = ("_queue",)

    def __init__(self) -> None:
        self._queue: queue.SimpleQueue[None] = queue.SimpleQueue()

    def set(self) -> None:
        """Wake. Callable from any thread, and from signal handlers."""
        if self._queue.empty():
            self._queue.put(None)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait to be woken, at most `timeout` seconds; whether it was."""
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
        """Wait until `condition()` holds, looking again whenever woken, at most `timeout` seconds; whether it does."""
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
        """What one thread waits with: this itself, or another where this is in use."""
        with self._taking:
            wake = Wake() if self._is_taken else self
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
