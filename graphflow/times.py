"""Points in time and durations in whole nanoseconds, as in ROS 2. No clock is read here."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, overload

NANOSECONDS = 1_000_000_000
"""Nanoseconds in a second."""


SECONDS: Mapping[str, float] = {
    "ns": 1e-9,
    **dict.fromkeys(("us", "\u00b5s", "\u03bcs"), 1e-6),
    **dict.fromkeys(("ms", "msec", "milliseconds"), 1e-3),
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), 1.0),
    **dict.fromkeys(("m", "min", "mins", "minute", "minutes"), 60.0),
    **dict.fromkeys(("h", "hr", "hour", "hours"), 3600.0),
}
"""Units of time, with their lengths in seconds."""
_WITH_UNIT = re.compile(r"\s*([-+]?\d+(?:\.\d+)?)\s*([^\W\d]+)\s*")


def seconds_in(text: str) -> str:
    """Return the seconds of a duration with a unit, as a number to write: 0.5 for `500ms`; empty for other texts."""
    found = _WITH_UNIT.fullmatch(text)
    factor = SECONDS.get(found[2].lower()) if found else None
    return "" if found is None or factor is None else f"{float(found[1]) * factor:.9f}".rstrip("0").rstrip(".")


def to_ns(seconds: float) -> int:
    """Convert seconds to whole nanoseconds, rounded to nearest. Raises TypeError for other values than numbers."""
    try:
        return round((seconds + 0) * NANOSECONDS)  # `+ 0` refuses texts, which `*` would repeat
    except TypeError:
        pass
    raise TypeError(f"a time is a number of seconds, such as 0.5, not {seconds!r}")


def ago(seconds: float) -> str:
    """Format a duration in at most two units: `12s`, `3m04s`, `2h05m`."""
    whole = max(0, int(seconds))
    if whole < 60:
        return f"{whole}s"
    if whole < 3600:
        return f"{whole // 60}m{whole % 60:02d}s"
    return f"{whole // 3600}h{whole % 3600 // 60:02d}m"


class HasFields(Protocol):
    """A message of type builtin_interfaces/msg/Time or Duration, of any library."""

    @property
    def sec(self) -> int: ...
    @property
    def nanosec(self) -> int: ...


def _nanoseconds(message: HasFields) -> int:
    return message.sec * NANOSECONDS + message.nanosec


class TimeFields:
    """Arithmetic of the message class builtin_interfaces/msg/Time, which mixes with `Time`."""

    __slots__ = ()
    sec: int
    nanosec: int

    @overload
    def __sub__(self, other: Time | TimeFields) -> Duration: ...
    @overload
    def __sub__(self, other: Duration | DurationFields) -> Time: ...
    def __sub__(self, other: Any) -> Any:
        return Time.from_msg(self).__sub__(other)

    def __add__(self, other: Duration | DurationFields) -> Time:
        return Time.from_msg(self).__add__(other)

    def __eq__(self, other: object) -> bool:
        return Time.from_msg(self) == other if isinstance(other, Time) else super().__eq__(other)

    __hash__ = None  # type: ignore[assignment]  # messages can change

    def __lt__(self, other: Time | TimeFields) -> bool:
        return Time.from_msg(self) < _time(other)

    def __le__(self, other: Time | TimeFields) -> bool:
        return Time.from_msg(self) <= _time(other)

    def __gt__(self, other: Time | TimeFields) -> bool:
        return Time.from_msg(self) > _time(other)

    def __ge__(self, other: Time | TimeFields) -> bool:
        return Time.from_msg(self) >= _time(other)


class DurationFields:
    """Arithmetic of the message class builtin_interfaces/msg/Duration, which mixes with `Duration`."""

    __slots__ = ()
    sec: int
    nanosec: int

    def __add__(self, other: Duration | DurationFields) -> Duration:
        return Duration.from_msg(self).__add__(other)

    def __eq__(self, other: object) -> bool:
        return Duration.from_msg(self) == other if isinstance(other, Duration) else super().__eq__(other)

    __hash__ = None  # type: ignore[assignment]  # messages can change

    def __sub__(self, other: Duration | DurationFields) -> Duration:
        return Duration.from_msg(self).__sub__(other)

    def __neg__(self) -> Duration:
        return -Duration.from_msg(self)

    def __lt__(self, other: Duration | DurationFields) -> bool:
        return Duration.from_msg(self) < _duration(other)

    def __le__(self, other: Duration | DurationFields) -> bool:
        return Duration.from_msg(self) <= _duration(other)

    def __gt__(self, other: Duration | DurationFields) -> bool:
        return Duration.from_msg(self) > _duration(other)

    def __ge__(self, other: Duration | DurationFields) -> bool:
        return Duration.from_msg(self) >= _duration(other)


def _time(value: Time | TimeFields) -> Time:
    return Time.from_msg(value) if isinstance(value, TimeFields) else value


def warn_of_two_clocks(first_ns: int, second_ns: int) -> None:
    """Warn, once per line of user code, of two times that are so far apart that they are of two clocks."""
    if first_ns and second_ns and abs(first_ns - second_ns) > _TWO_CLOCKS:
        import warnings

        frame, depth = sys._getframe(1), 2
        while frame.f_back is not None and frame.f_globals.get("__name__") in _ARITHMETIC:
            frame, depth = frame.f_back, depth + 1
        text = "one of these two times is simulated, and the other is not: set use_sim_time for the node"
        warnings.warn(text, RuntimeWarning, stacklevel=depth)


SIMULATED = 1e8
"""Seconds, about three years, between a stamp and the clock beyond which one of them is of simulated time."""
_TWO_CLOCKS = 10**9 * NANOSECONDS
"""About 32 years."""
_ARITHMETIC = (__name__, "rclpy.time")


def _duration(value: Duration | DurationFields) -> Duration:
    return Duration.from_msg(value) if isinstance(value, DurationFields) else value


FROM_SECONDS: Mapping[str, str] = {
    "Duration": "Duration.of(seconds)",
    "Time": "self.clock.now(), or Time(round(seconds * 1e9))",
}
"""Expressions that make a duration and a time from seconds."""


def _refuse_fraction(name: str, value: object) -> None:
    """Raise TypeError for a number of nanoseconds that is not of an integer type."""
    if not hasattr(value, "__index__"):
        raise TypeError(f"{name} takes whole nanoseconds, not {value!r}; write {FROM_SECONDS[name]}")


@dataclass(frozen=True, order=True, slots=True)
class Duration:
    """A duration, which may be negative. Usable as a builtin_interfaces/msg/Duration."""

    nanoseconds: int

    def __post_init__(self) -> None:
        if self.nanoseconds.__class__ is not int:
            _refuse_fraction("Duration", self.nanoseconds)

    @classmethod
    def of(cls, seconds: float) -> Duration:
        """Return a duration of some seconds."""
        return cls(to_ns(seconds))

    @classmethod
    def from_msg(cls, message: HasFields) -> Duration:
        """Return the duration of a message of type builtin_interfaces/msg/Duration."""
        return cls(_nanoseconds(message))

    @property
    def seconds(self) -> float:
        return self.nanoseconds / NANOSECONDS

    @property
    def sec(self) -> int:
        """Whole seconds, rounded down, as the message field."""
        return self.nanoseconds // NANOSECONDS

    @property
    def nanosec(self) -> int:
        """The remaining nanoseconds, 0 to 999,999,999, as the message field."""
        return self.nanoseconds % NANOSECONDS

    def __add__(self, other: Duration | DurationFields) -> Duration:
        other = _duration(other)
        return Duration(self.nanoseconds + other.nanoseconds) if isinstance(other, Duration) else NotImplemented

    def __sub__(self, other: Duration | DurationFields) -> Duration:
        other = _duration(other)
        return Duration(self.nanoseconds - other.nanoseconds) if isinstance(other, Duration) else NotImplemented

    def __neg__(self) -> Duration:
        return Duration(-self.nanoseconds)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, DurationFields):
            other = Duration.from_msg(other)
        return self.nanoseconds == other.nanoseconds if isinstance(other, Duration) else NotImplemented


@dataclass(frozen=True, order=True, slots=True)
class Time:
    """A point in time, in nanoseconds since the epoch of its clock. Usable as a builtin_interfaces/msg/Time.

    `Time - Time` is a `Duration`; `Time + Duration` and `Time - Duration` are a `Time`. Messages, such as
    `header.stamp`, can replace either.
    """

    nanoseconds: int

    def __post_init__(self) -> None:
        if self.nanoseconds.__class__ is not int:
            _refuse_fraction("Time", self.nanoseconds)

    @classmethod
    def from_msg(cls, message: HasFields) -> Time:
        """Return the time of a message of type builtin_interfaces/msg/Time, such as `header.stamp`."""
        return cls(_nanoseconds(message))

    @property
    def seconds(self) -> float:
        return self.nanoseconds / NANOSECONDS

    @property
    def sec(self) -> int:
        """Whole seconds since the epoch, as the message field."""
        return self.nanoseconds // NANOSECONDS

    @property
    def nanosec(self) -> int:
        """The remaining nanoseconds, 0 to 999,999,999, as the message field."""
        return self.nanoseconds % NANOSECONDS

    def __add__(self, other: Duration | DurationFields) -> Time:
        other = _duration(other)
        return Time(self.nanoseconds + other.nanoseconds) if isinstance(other, Duration) else NotImplemented

    @overload
    def __sub__(self, other: Time | TimeFields) -> Duration: ...
    @overload
    def __sub__(self, other: Duration | DurationFields) -> Time: ...
    def __sub__(self, other: Any) -> Any:
        if isinstance(other, (Time, TimeFields)):
            since = _time(other).nanoseconds
            warn_of_two_clocks(self.nanoseconds, since)
            return Duration(self.nanoseconds - since)
        if isinstance(other, (Duration, DurationFields)):
            return Time(self.nanoseconds - _duration(other).nanoseconds)
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        if isinstance(other, TimeFields):
            other = Time.from_msg(other)
        return self.nanoseconds == other.nanoseconds if isinstance(other, Time) else NotImplemented
