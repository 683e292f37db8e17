"""Synchronizers of message_filters that never pass anything on, since no stamps of their inputs fit together.

ROS 2 drops the messages silently.
"""

from __future__ import annotations

import logging
import time
from bisect import bisect_left
from collections import deque
from collections.abc import Iterator, Sequence

WARN_AFTER = 3.0
"""Seconds from the first message."""
ENOUGH = 10
"""The number of messages that each input must have had, or one more than its queue has room for."""
ENOUGH_BOUND = 100
"""The greatest number of messages to wait for, if the queues are longer."""
KEPT_BOUND = 1000
"""The number of stamps to remember of each input, at most."""
_SLOPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
"""Values of `slop` to propose, in seconds."""
_STAMP = "message.header.stamp = self.get_clock().now().to_msg()"
logger = logging.getLogger("graphflow")


class Unmatched:
    """The stamps of one synchronizer's inputs until a first set is complete.

    Args:
        kind: The synchronizer's class.
        place: Its line, as in `lamp.py:12: `.
        names: The inputs' names.
        queue_size: The number of messages of each input that wait for the others.
        slop_ns: The difference in nanoseconds that stamps of a set must be below; 0 if they must be equal.
    """

    def __init__(self, kind: str, place: str, names: Sequence[str], queue_size: int, slop_ns: int) -> None:
        self._kind, self._place, self._names = kind, place, names
        self._queue_size, self._slop_ns = queue_size, slop_ns
        self._stamps = [deque[int](maxlen=min(max(100, 4 * queue_size), KEPT_BOUND)) for _ in names]
        self._counts = [0 for _ in names]
        self._enough = min(max(queue_size, ENOUGH), ENOUGH_BOUND)
        self._begun: float | None = None

    def take(self, index: int, stamp_ns: int) -> bool:
        """Take a stamp of an input; return whether the lack of sets has been reported."""
        self._stamps[index].append(stamp_ns)
        self._counts[index] += 1
        if self._begun is None:
            self._begun = time.monotonic()
        if min(self._counts) <= self._enough or time.monotonic() - self._begun < WARN_AFTER:
            return False
        logger.warning("%s", self._text())
        return True

    def _text(self) -> str:
        had = f"{self._place}this {self._kind} has received {min(self._counts)} messages of each of "
        had += f"{' and '.join(self._names)}, and no complete set"
        bare = [name for name, stamps in zip(self._names, self._stamps, strict=True) if not any(stamps)]
        if bare:
            return f"{had}: those of {' and '.join(bare)} have no stamp; write {_STAMP} where they are made"
        nearest = min(self._sets(), key=lambda stamps: (max(stamps) - min(stamps), -stamps[0]))
        apart_ns = max(nearest) - min(nearest)
        if apart_ns < max(self._slop_ns, 1):
            later = max(sum(at >= min(nearest) for at in stamps) for stamps in self._stamps)
            size = 2 * max(later, self._queue_size)
            return f"{had}: some come so late that the others are dropped before; write queue_size={size}"
        apart = apart_ns / 1e9
        slop = next((slop for slop in _SLOPS if slop >= 2 * apart), None)
        if slop is None:
            return f"{had}: their stamps differ by at least {apart:.1f} s; compare the clocks that they come from"
        near = f"their stamps differ by at least {1000 * apart:.2g} ms"
        if self._slop_ns:
            return f"{had}: {near}, and slop={self._slop_ns / 1e9:g}; write slop={slop:g}"
        return (
            f"{had}: {near}, and must be equal; write ApproximateTimeSynchronizer([...], {self._queue_size}, {slop:g})"
        )

    def _sets(self) -> Iterator[list[int]]:
        """Yield the stamps nearest to each stamp of the first input, one per input."""
        first, *others = map(sorted, self._stamps)
        for stamp in first:
            yield [stamp, *(_nearest(stamp, stamps) for stamps in others)]


def _nearest(stamp: int, stamps: list[int]) -> int:
    at = bisect_left(stamps, stamp)
    return min(stamps[max(at - 1, 0) : at + 1], key=lambda other: abs(other - stamp))
