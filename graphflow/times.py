"""Points in time and spans of time in whole nanoseconds, as ROS 2 carries them. No clock is read here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import overload

NANOSECONDS = 1_000_000_000
"""Nanoseconds in a second."""


def to_ns(seconds: float) -> int:
    """Seconds as whole nanoseconds, rounded to nearest."""
    return round(seconds * NANOSECONDS)


def ago(seconds: float) -> str:
    """A span in two units at most: `12s`, `3m04s`, `2h05m`."""
    whole = max(0, int(seconds))
    if whole < 60:
        return f"{whole}s"
    if whole < 3600:
        return f"{whole // 60}m{whole % 60:02d}s"
    return f"{whole // 3600}h{whole % 3600 // 60:02d}m"


@dataclass(frozen=True, order=True, slots=True)
class Duration:
    """A span of time; may be negative. Fits builtin_interfaces/msg/Duration."""

    nanoseconds: int

    @classmethod
    def of(cls, seconds: float) -> Duration:
        """A span of this many seconds."""
        return cls(to_ns(seconds))

    @property
    def seconds(self) -> float:
        return self.nanoseconds / NANOSECONDS

    @property
    def sec(self) -> int:
        """Whole seconds, rounded down, as the message field."""
        return self.nanoseconds // NANOSECONDS

    @property
    def nanosec(self) -> int:
        """The rest, 0 to 999,999,999, as the message field."""
        return self.nanoseconds % NANOSECONDS

    def __add__(self, other: Duration) -> Duration:
        return Duration(self.nanoseconds + other.nanoseconds) if isinstance(other, Duration) else NotImplemented

    def __sub__(self, other: Duration) -> Duration:
        return Duration(self.nanoseconds - other.nanoseconds) if isinstance(other, Duration) else NotImplemented

    def __neg__(self) -> Duration:
        return Duration(-self.nanoseconds)


@dataclass(frozen=True, order=True, slots=True)
class Time:
    """A point on a clock, in nanoseconds since its epoch. Fits builtin_interfaces/msg/Time.

    `Time - Time` is a `Duration`; `Time + Duration` and `Time - Duration` are a `Time`.
    """

    nanoseconds: int

    @property
    def seconds(self) -> float:
        return self.nanoseconds / NANOSECONDS

    @property
    def sec(self) -> int:
        """Whole seconds since the epoch, as the message field."""
        return self.nanoseconds // NANOSECONDS

    @property
    def nanosec(self) -> int:
        """The rest, 0 to 999,999,999, as the message field."""
        return self.nanoseconds % NANOSECONDS

    def __add__(self, other: Duration) -> Time:
        return Time(self.nanoseconds + other.nanoseconds) if isinstance(other, Duration) else NotImplemented

    @overload
    def __sub__(self, other: Time) -> Duration: ...
    @overload
    def __sub__(self, other: Duration) -> Time: ...
    def __sub__(self, other: Time | Duration) -> Time | Duration:
        if isinstance(other, Time):
            return Duration(self.nanoseconds - other.nanoseconds)
        return Time(self.nanoseconds - other.nanoseconds) if isinstance(other, Duration) else NotImplemented
