"""Rates, delays and sizes of messages, formatted as by `ros2 topic hz`, `delay` and `bw`.

The statistics are of a window of the last messages. Times are nanoseconds; the deviation is the population's.
"""

from __future__ import annotations

import itertools
import statistics
from collections import deque
from typing import NamedTuple

from graphflow.times import SIMULATED


class Spread(NamedTuple):
    """Mean, extremes and standard deviation of some numbers."""

    mean: float
    least: float
    most: float
    deviation: float
    window: int
    """Number of values."""

    @classmethod
    def of(cls, numbers: list[float]) -> Spread:
        """Args: numbers: At least one."""
        mean = statistics.fmean(numbers)
        return cls(mean, min(numbers), max(numbers), statistics.pstdev(numbers, mean), len(numbers))


class Arrivals:
    """Times at which messages arrived.

    Args:
        window: Number of gaps between messages to keep.
    """

    def __init__(self, window: int) -> None:
        self.count = 0
        """Number of all messages."""
        self._times: deque[int] = deque(maxlen=window + 1)

    def add(self, now_ns: int) -> None:
        self.count += 1
        self._times.append(now_ns)

    def gaps(self) -> Spread | None:
        """Return seconds between messages; None while there are fewer than two messages."""
        gaps = [(b - a) / 1e9 for a, b in itertools.pairwise(self._times)]
        return Spread.of(gaps) if gaps else None

    @staticmethod
    def rate(gaps: Spread) -> float:
        """Return messages per second."""
        return 1 / gaps.mean if gaps.mean else 0.0

    def numbers(self) -> dict[str, float] | None:
        """Return messages per second and seconds between them; None while there are fewer than two messages."""
        gaps = self.gaps()
        return None if gaps is None else {"rate": self.rate(gaps), **_as_dict(gaps)}

    def text(self) -> str:
        """Format the rate as `ros2 topic hz` does; empty while there are fewer than two messages."""
        gaps = self.gaps()
        if gaps is None:
            return ""
        return f"average rate: {self.rate(gaps):.3f}\n\t{_spread(gaps)}"


class Delays:
    """Ages of messages on arrival, by the stamps in their headers.

    Args:
        window: Number of messages to keep.
    """

    def __init__(self, window: int) -> None:
        self._delays: deque[float] = deque(maxlen=window)

    def add(self, delay_ns: int) -> None:
        self._delays.append(delay_ns / 1e9)

    def spread(self) -> Spread | None:
        """Return seconds of delay; None while there is no message."""
        return Spread.of(list(self._delays)) if self._delays else None

    def numbers(self) -> dict[str, float] | None:
        """Return seconds of delay by statistic; None while there is no message."""
        spread = self.spread()
        return None if spread is None else {"delay": spread.mean, **_as_dict(spread)}

    def text(self) -> str:
        """Format the delay as `ros2 topic delay` does; empty while there is no message."""
        spread = self.spread()
        if spread is None:
            return ""
        odd = "; the stamps seem to be of simulated time" if abs(spread.mean) > SIMULATED else ""
        return f"average delay: {spread.mean:.3f}{odd}\n\t{_spread(spread)}"


class Weights:
    """Sizes of messages and the times at which they arrived.

    Args:
        window: Number of messages to keep.
    """

    def __init__(self, window: int) -> None:
        self._arrivals: deque[tuple[int, int]] = deque(maxlen=window)

    def add(self, now_ns: int, size: int) -> None:
        self._arrivals.append((now_ns, size))

    def per_second(self, now_ns: int) -> float:
        """Return bytes per second from the first message of the window until now; 0 while there is none."""
        if not self._arrivals:
            return 0.0
        seconds = (now_ns - self._arrivals[0][0]) / 1e9
        return sum(size for _, size in self._arrivals) / seconds if seconds > 0 else 0.0

    def sizes(self) -> Spread | None:
        """Return bytes per message; None while there are fewer than two messages."""
        return Spread.of([float(size) for _, size in self._arrivals]) if len(self._arrivals) > 1 else None

    def numbers(self, now_ns: int) -> dict[str, float] | None:
        """Return bytes per second and per message; None while there are fewer than two messages."""
        sizes = self.sizes()
        if sizes is None:
            return None
        return {"bytes_per_second": self.per_second(now_ns), "mean": sizes.mean, **_as_dict(sizes)}

    def text(self, now_ns: int) -> str:
        """Format the bandwidth as `ros2 topic bw` does; empty while there are fewer than two messages."""
        sizes = self.sizes()
        if sizes is None:
            return ""
        unit, by = _unit(self.per_second(now_ns))  # one unit for all numbers, as in ROS 2
        total, mean, least, most = (f"{n / by:.2f} {unit}" for n in (self.per_second(now_ns), *sizes[:3]))
        return f"{total}/s from {sizes.window} messages\n\tMessage size mean: {mean} min: {least} max: {most}"


def _as_dict(spread: Spread) -> dict[str, float]:
    return {"min": spread.least, "max": spread.most, "std_dev": spread.deviation, "window": spread.window}


def _spread(spread: Spread) -> str:
    times = f"min: {spread.least:.3f}s max: {spread.most:.3f}s std dev: {spread.deviation:.5f}s"
    return f"{times} window: {spread.window}"


def _unit(size: float) -> tuple[str, float]:
    """Return the unit for a number of bytes, and the bytes in one unit."""
    return ("B", 1.0) if size < 1000 else ("KB", 1e3) if size < 1e6 else ("MB", 1e6)


def table(rows: dict[str, Arrivals]) -> str:
    """Format the rates of several topics as `ros2 topic hz` does; empty while there is none."""
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
