"""How fast messages come, how late, and how much they weigh, in the words of `ros2 topic hz`, `delay` and `bw`.

The numbers are of a window of the last messages. Times are nanoseconds; a deviation is that of the whole window.
"""

from __future__ import annotations

import itertools
import statistics
from collections import deque
from typing import NamedTuple


class Spread(NamedTuple):
    """Mean, extremes and deviation of some numbers."""

    mean: float
    least: float
    most: float
    deviation: float
    window: int
    """How many numbers."""

    @classmethod
    def of(cls, numbers: list[float]) -> Spread:
        """Args: numbers: At least one."""
        mean = statistics.fmean(numbers)
        return cls(mean, min(numbers), max(numbers), statistics.pstdev(numbers, mean), len(numbers))


class Arrivals:
    """When messages came.

    Args:
        window: How many gaps between messages count.
    """

    def __init__(self, window: int) -> None:
        self.count = 0
        """All that came."""
        self._times: deque[int] = deque(maxlen=window + 1)

    def add(self, now_ns: int) -> None:
        self.count += 1
        self._times.append(now_ns)

    def gaps(self) -> Spread | None:
        """Seconds between messages; None while there are fewer than two."""
        gaps = [(b - a) / 1e9 for a, b in itertools.pairwise(self._times)]
        return Spread.of(gaps) if gaps else None

    @staticmethod
    def rate(gaps: Spread) -> float:
        """Messages a second."""
        return 1 / gaps.mean if gaps.mean else 0.0

    def numbers(self) -> dict[str, float] | None:
        """For programs: messages a second, and seconds between them; None while there is nothing to tell."""
        gaps = self.gaps()
        return None if gaps is None else {"rate": self.rate(gaps), **_named(gaps)}

    def text(self) -> str:
        """As `ros2 topic hz` prints it; empty while there is nothing to tell."""
        gaps = self.gaps()
        if gaps is None:
            return ""
        return f"average rate: {self.rate(gaps):.3f}\n\t{_spread(gaps)}"


class Delays:
    """How old messages were when they came, by the stamps in their headers.

    Args:
        window: How many messages count.
    """

    def __init__(self, window: int) -> None:
        self._delays: deque[float] = deque(maxlen=window)

    def add(self, delay_ns: int) -> None:
        self._delays.append(delay_ns / 1e9)

    def spread(self) -> Spread | None:
        """Seconds; None while there is no message."""
        return Spread.of(list(self._delays)) if self._delays else None

    def numbers(self) -> dict[str, float] | None:
        """For programs, in seconds; None while there is nothing to tell."""
        spread = self.spread()
        return None if spread is None else {"delay": spread.mean, **_named(spread)}

    def text(self) -> str:
        """As `ros2 topic delay` prints it; empty while there is nothing to tell."""
        spread = self.spread()
        if spread is None:
            return ""
        return f"average delay: {spread.mean:.3f}\n\t{_spread(spread)}"


class Weights:
    """How many bytes came when.

    Args:
        window: How many messages count.
    """

    def __init__(self, window: int) -> None:
        self._came: deque[tuple[int, int]] = deque(maxlen=window)

    def add(self, now_ns: int, size: int) -> None:
        self._came.append((now_ns, size))

    def per_second(self, now_ns: int) -> float:
        """Bytes a second from the first message of the window until now; 0 while there is none."""
        if not self._came:
            return 0.0
        seconds = (now_ns - self._came[0][0]) / 1e9
        return sum(size for _, size in self._came) / seconds if seconds > 0 else 0.0

    def sizes(self) -> Spread | None:
        """Bytes of messages; None while there are fewer than two."""
        return Spread.of([float(size) for _, size in self._came]) if len(self._came) > 1 else None

    def numbers(self, now_ns: int) -> dict[str, float] | None:
        """For programs: bytes a second, and bytes of messages; None while there is nothing to tell."""
        sizes = self.sizes()
        if sizes is None:
            return None
        return {"bytes_per_second": self.per_second(now_ns), "mean": sizes.mean, **_named(sizes)}

    def text(self, now_ns: int) -> str:
        """As `ros2 topic bw` prints it; empty while there are fewer than two messages."""
        sizes = self.sizes()
        if sizes is None:
            return ""
        unit, by = _unit(self.per_second(now_ns))  # for all, as ROS 2 has it
        total, mean, least, most = (f"{n / by:.2f} {unit}" for n in (self.per_second(now_ns), *sizes[:3]))
        return f"{total}/s from {sizes.window} messages\n\tMessage size mean: {mean} min: {least} max: {most}"


def _named(spread: Spread) -> dict[str, float]:
    return {"min": spread.least, "max": spread.most, "std_dev": spread.deviation, "window": spread.window}


def _spread(spread: Spread) -> str:
    times = f"min: {spread.least:.3f}s max: {spread.most:.3f}s std dev: {spread.deviation:.5f}s"
    return f"{times} window: {spread.window}"


def _unit(size: float) -> tuple[str, float]:
    """The unit for a number of bytes, and how many it has."""
    return ("B", 1.0) if size < 1000 else ("KB", 1e3) if size < 1e6 else ("MB", 1e6)


def table(rows: dict[str, Arrivals]) -> str:
    """The rates of several topics, as `ros2 topic hz` prints them; empty while there is nothing to tell."""
    head = ("topic", "rate", "min_delta", "max_delta", "std_dev", "window")
    lines = [
        (name, f"{Arrivals.rate(g):.2f}", f"{g.least:.2e}", f"{g.most:.2e}", f"{g.deviation:.2e}", str(g.window))
        for name, arrivals in rows.items()
        if (g := arrivals.gaps()) is not None
    ]
    if not lines:
        return ""
    widths = [max(map(len, column)) for column in zip(head, *lines, strict=True)]
    rule = "=" * (sum(widths) + 2 * (len(widths) - 1))
    texts = ["  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=True)) for line in (head, *lines)]
    return "\n".join([texts[0].rstrip(), rule, *(text.rstrip() for text in texts[1:])])
