"""Points in time and spans of time in whole nanoseconds, as ROS 2 carries them. No clock is read here."""

from __future__ import annotations

from typing import NamedTuple

NANOSECONDS = 1_000_000_000
"""Nanoseconds in a second."""


def to_ns(seconds: float) -> int:
    """Seconds as whole nanoseconds, rounded to nearest."""
    return round(seconds * NANOSECONDS)


class Duration(NamedTuple):
    """A span of time; may be negative. Fits builtin_interfaces/msg/Duration."""

    nanoseconds: int

    @classmethod
    def of(cls, seconds: float) -> Duration:
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


class Time(NamedTuple):
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

    def __add__(self, other: object) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        return Time(self.nanoseconds + other.nanoseconds)

    def since(self, earlier: Time) -> Duration:
        """How long after `earlier` this is."""
        return Duration(self.nanoseconds - earlier.nanoseconds)
