"""How often something has happened in the last moment, for those who ask once."""

from __future__ import annotations

import time
from collections import deque

WINDOW = 0.5
"""Seconds that are looked back on."""
MOST = 500
"""Times that are remembered."""


class Lately:
    """The times at which something has happened. Free of locks: a deque's methods are atomic."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=MOST)

    def note(self) -> None:
        """It happens now."""
        self._times.append(time.monotonic())

    @property
    def rate(self) -> float:
        """How often a second it has happened, up to `MOST / WINDOW`."""
        since = time.monotonic() - WINDOW
        return sum(at > since for at in tuple(self._times)) / WINDOW
