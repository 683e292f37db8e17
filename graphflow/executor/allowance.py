"""How often something may be done for others: a bucket of turns that fills again with time."""

from __future__ import annotations

from collections.abc import Callable

from graphflow.times import NANOSECONDS


class Allowance:
    """So many turns a second, and as many at once after a rest. Callable from any thread.

    Args:
        per_second: Turns that come back each second, and the most that gather.
        now_ns: Tells the time, in nanoseconds.
    """

    __slots__ = ("_left", "_now_ns", "_per_second", "_since", "refused")

    def __init__(self, per_second: float, now_ns: Callable[[], int]) -> None:
        self._per_second = self._left = per_second
        self._now_ns, self._since = now_ns, now_ns()
        self.refused = 0
        """Turns that were wanted and not there."""

    def take(self) -> bool:
        """Whether there is a turn; it is then taken."""
        now = self._now_ns()
        self._left = min(self._per_second, self._left + (now - self._since) / NANOSECONDS * self._per_second)
        self._since = now
        if self._left < 1.0:
            self.refused += 1
            return False
        self._left -= 1.0
        return True
