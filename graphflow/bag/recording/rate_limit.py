"""How often a topic is recorded."""

from __future__ import annotations


class RateLimit:
    """Lets the first message pass, and of the others no more than so many a second, as evenly as they come.

    Args:
        rate: Messages a second.
    """

    def __init__(self, rate: float) -> None:
        self._period_ns = round(1e9 / rate)
        self._due_ns: int | None = None

    def passes(self, now_ns: int) -> bool:
        """Whether a message that comes now is recorded."""
        due_ns = self._due_ns
        if due_ns is None or not -self._period_ns <= now_ns - due_ns < self._period_ns:
            self._due_ns = now_ns + self._period_ns  # the first one, one after a pause, or time has been set back
            return True
        if now_ns < due_ns:
            return False
        # From when it was due, not from now: 20 a second of 30 are two of three then, and not every second one.
        self._due_ns = due_ns + self._period_ns
        return True
