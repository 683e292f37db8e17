"""A subscription that its own node feeds: a handler that publishes to its own topic never comes to an end.

Nothing is counted for it while messages pass: the subscription's own numbers are compared once a second, for as long as
the publishers of its topic are all its node's.
"""

from __future__ import annotations

from collections.abc import Callable

from graphflow.executor.clock import Alarm, Clock
from graphflow.times import NANOSECONDS

LOOP = 2000
"""Messages a second, in two seconds in a row, from which on it is told; slower loops are left to `doctor`."""


class Echo:
    """Watches one subscription until `tell` has been called.

    Args:
        received: The number of messages that it has received.
        tell: Called once with the messages a second.
    """

    def __init__(self, clock: Clock, received: Callable[[], int], tell: Callable[[int], None]) -> None:
        self._clock, self._received, self._tell = clock, received, tell
        self._alarm: Alarm | None = None
        self._last = 0
        self._is_told = self._was_fast = False

    def follow(self, *, is_alone: bool) -> None:
        """A publisher came or went: watch while the node's own is the only one."""
        if not is_alone:
            self.stop()
        elif self._alarm is None and not self._is_told:
            self._last, self._was_fast = self._received(), False
            self._arm()

    def stop(self) -> None:
        """Watch no more, until the next `follow`."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def _arm(self) -> None:
        self._alarm = self._clock.call_at(self._clock.monotonic_ns() + NANOSECONDS, self._look)

    def _look(self) -> None:
        self._alarm, received = None, self._received()
        rate, self._last = received - self._last, received
        if rate >= LOOP and self._was_fast:
            self._is_told = True
            self._tell(rate)
        else:
            self._was_fast = rate >= LOOP
            self._arm()
