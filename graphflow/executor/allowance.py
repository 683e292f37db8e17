"""Rate limiting of work on behalf of other processes, by a token bucket."""

from __future__ import annotations

from collections.abc import Callable

from graphflow.times import NANOSECONDS


class Allowance:
    """A token bucket: a rate, and a burst of one second's tokens. Callable from any thread.

    Args:
        per_second: Tokens added per second, which is also the capacity.
        now_ns: Returns the time in nanoseconds.
    """

    __slots__ = ("_left", "_now_ns", "_per_second", "_since", "refused")

    def __init__(self, per_second: float, now_ns: Callable[[], int]) -> None:
        self._per_second = self._left = per_second
        self._now_ns, self._since = now_ns, now_ns()
        self.refused = 0
        """Requests refused for lack of a token."""

    def take(self) -> bool:
        """Take a token; returns False if there is none."""
        now = self._now_ns()
        self._left = min(self._per_second, self._left + (now - self._since) / NANOSECONDS * self._per_second)
        self._since = now
        if self._left < 1.0:
            self.refused += 1
            return False
        self._left -= 1.0
        return True
