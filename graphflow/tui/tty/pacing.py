"""Frames on slow terminals: where one is still being written, the next ones are left out, and then all is drawn anew.

Textual queues thirty frames for its writing thread. On a link of 20 kB/s that is what a key waits for until its effect
is seen.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

LATE = 0.05
"""Seconds that a frame may wait for Textual's writing thread before the terminal is taken for slow."""


class Pacing:
    """Whether the terminal keeps up with one console.

    Args:
        clock: Seconds since some moment.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.owes = False
        """Whether frames were left out since the screen was drawn as a whole."""
        self.left_out = 0
        self._clock = clock
        self._waits_since: float | None = None
        """When frames were first seen to wait; None if none did when it was looked at last."""

    def admits(self, driver: Any) -> bool:
        """Whether another frame may be written now; counts it, if not.

        Args:
            driver: Textual's, which writes in a thread of its own.
        """
        if not waiting(driver):
            self._waits_since = None
        elif self._waits_since is None:
            self._waits_since = self._clock()
        if not self.owes and (self._waits_since is None or self._clock() - self._waits_since < LATE):
            return True
        self.owes = True
        self.left_out += 1
        return False

    def catches_up(self, driver: Any) -> bool:
        """Whether frames were left out, and the terminal has taken what was written: now all is to be drawn."""
        if not self.owes or waiting(driver):
            return False
        self.owes = False
        return True


def waiting(driver: Any) -> int:
    """The writes that the terminal has not taken yet; none for drivers that do not tell."""
    thread = getattr(driver, "_writer_thread", None)
    queue = getattr(thread, "_queue", None)
    return 0 if queue is None else int(queue.qsize())
