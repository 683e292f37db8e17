"""A limit on the rate at which a topic is recorded."""

from __future__ import annotations


class RateLimit:
    """Passes the first message, and of the others at most a number per second, as evenly as they come.

    Args:
        rate: Messages per second.
    """

    def __init__(self, rate: float) -> None:
        self._period_ns = round(1e9 / rate)
        self._due_ns: int | None = None

    def passes(self, now_ns: int) -> bool:
        """Return whether a message that arrives now is recorded."""
        due_ns = self._due_ns
        if due_ns is None or not -self._period_ns <= now_ns - due_ns < self._period_ns:
            self._due_ns = now_ns + self._period_ns  # the first, one after a pause, or a clock that was set back
            return True
        if now_ns < due_ns:
            return False
        # Counted from when it was due, not from now: 20 per second of 30 are two of three then, not every second one.
        self._due_ns = due_ns + self._period_ns
        return True
