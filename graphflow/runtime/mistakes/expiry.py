"""Subscriptions none of whose messages arrive within their lifespan, so that nothing is ever received."""

from __future__ import annotations

from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS, to_ns

MANY = 5
"""Expired messages before a warning."""
SECONDS = 3.0
"""Seconds between the first and the last of them: after a blocked loop, many expire at one moment."""


class Expiry:
    """The expired messages of one subscription."""

    def __init__(self, host: Host, name: str) -> None:
        self._host, self._name = host, name
        self.count = 0
        self._since_ns = 0
        self._has_warned = False

    def add(self, taken: int, lifespan_ns: int, late_ns: int) -> None:
        """Count an expired message, and warn once if all have expired.

        Args:
            taken: Messages taken from the queue so far, this one included.
            late_ns: The time by which it has exceeded its lifespan.
        """
        self.count += 1
        if self._has_warned or taken > self.count:
            return
        now_ns = self._host.context.clock.monotonic_ns()
        if self.count == 1:
            self._since_ns = now_ns
        if self.count >= MANY and now_ns - self._since_ns >= to_ns(SECONDS):
            self._has_warned = True
            clocks = "; are the clocks of the two machines the same?" if late_ns > NANOSECONDS else ""
            text = "%s: all %d messages so far have exceeded their lifespan of %s, the last by %s, and are dropped: "
            text += "give it a longer lifespan%s"
            self._host.log.warning(text, self._name, self.count, _span(lifespan_ns), _span(late_ns), clocks)


def _span(span_ns: int) -> str:
    """Return a time span with its unit."""
    for unit, size in (("s", NANOSECONDS), ("ms", 1_000_000), ("us", 1_000)):
        if span_ns >= size:
            return f"{span_ns / size:.3g} {unit}"
    return f"{span_ns} ns"
