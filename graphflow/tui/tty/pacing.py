"""Flow control for slow terminals: skip frames while one is being written, then redraw the whole screen.

Textual queues up to thirty frames for its writing thread. On a link of 20 kB/s, the effect of a key would appear only
after all of them.
"""

from __future__ import annotations

import time
from collections.abc import Callable

LATE = 0.05
"""Seconds that a frame may wait for Textual's writing thread before the terminal counts as slow."""


class Pacing:
    """The decision to write or skip frames of one console.

    Args:
        clock: A monotonic clock in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.is_behind = False
        """Whether frames were skipped since the last full redraw."""
        self.left_out = 0
        self._clock = clock
        self._waits_since: float | None = None
        """The time since which frames have been waiting; None if none was at the last check."""

    def admits(self, driver: object) -> bool:
        """Return whether another frame may be written now; count it as skipped if not.

        Args:
            driver: Textual's driver, which writes in a thread of its own.
        """
        if not waiting(driver):
            self._waits_since = None
        elif self._waits_since is None:
            self._waits_since = self._clock()
        if not self.is_behind and (self._waits_since is None or self._clock() - self._waits_since < LATE):
            return True
        self.is_behind = True
        self.left_out += 1
        return False

    def catches_up(self, driver: object) -> bool:
        """Return whether a full redraw is due: frames were skipped, and the terminal has caught up."""
        if not self.is_behind or waiting(driver):
            return False
        self.is_behind = False
        return True


def waiting(driver: object) -> int:
    """Return the number of pending writes; 0 for drivers without a writing thread."""
    # Textual has no public name for the queue, and only drivers of real terminals have one.
    thread = getattr(driver, "_writer_thread", None)
    queue = getattr(thread, "_queue", None)
    return 0 if queue is None else int(queue.qsize())
