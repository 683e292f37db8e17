"""How often something may be done for others: a bucket of turns that fills again with time."""

from __future__ import annotations

from time import monotonic


class Allowance:
    """So many turns a second, and as many at once after a rest. Callable from any thread.

    Args:
        per_second: Turns that come back each second, and the most that gather.
    """

    __slots__ = ("_left", "_per_second", "_since", "refused")

    def __init__(self, per_second: float) -> None:
        self._per_second = self._left = per_second
        self._since = monotonic()
        self.refused = 0
        """Turns that were wanted and not there."""

    def take(self) -> bool:
        """Whether there is a turn; it is then taken."""
        now = monotonic()
        self._left = min(self._per_second, self._left + (now - self._since) * self._per_second)
        self._since = now
        if self._left < 1.0:
            self.refused += 1
            return False
        self._left -= 1.0
        return True
