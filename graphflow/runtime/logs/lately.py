"""Rates of recent events, computed on demand."""

from __future__ import annotations

import time
from collections import deque

WINDOW = 0.5
"""Seconds covered by the rate."""
MOST = 500
"""Times kept."""


class Lately:
    """The times of recent events. Lock-free: a deque's methods are atomic."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=MOST)

    def note(self) -> None:
        """Record an event."""
        self._times.append(time.monotonic())

    @property
    def rate(self) -> float:
        """Return the recent events per second, at most `MOST / WINDOW`."""
        since = time.monotonic() - WINDOW
        return sum(at > since for at in tuple(self._times)) / WINDOW
