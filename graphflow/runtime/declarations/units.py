"""Units of parameters that contradict their use: a parameter in Hz or ms where a period in seconds is taken."""

from __future__ import annotations

from typing import Literal

from graphflow.interface import Parameter

Taken = Literal["s", "Hz"]
"""The unit that a timer, a timeout or a frequency takes."""

_HERTZ = {"hz", "1/s", "s^-1", "1/sec", "1/second"}
_FREQUENCIES = {"khz": 1e3, "mhz": 1e6, "rpm": 1 / 60, "1/min": 1 / 60, "bpm": 1 / 60}
"""Other units of frequency, in Hz."""
_SECONDS = {"s", "sec", "secs", "second", "seconds"}
_TIMES = {
    **dict.fromkeys(("ms", "msec", "msecs", "millis", "millisecond", "milliseconds"), 1e-3),
    **dict.fromkeys(("us", "\u00b5s", "\u03bcs", "usec", "microsecond", "microseconds"), 1e-6),
    **dict.fromkeys(("ns", "nsec", "nanosecond", "nanoseconds"), 1e-9),
    **dict.fromkeys(("min", "minute", "minutes"), 60.0),
    **dict.fromkeys(("h", "hour", "hours"), 3600.0),
}
"""Other units of time, in seconds."""


def is_frequency(parameter: Parameter) -> bool:
    """Whether the parameter's unit is one of frequency."""
    unit = parameter.unit.strip().lower()
    return unit in _HERTZ or unit in _FREQUENCIES


def is_base(parameter: Parameter) -> bool:
    """Whether the parameter's unit is s or Hz."""
    return parameter.unit.strip().lower() in _HERTZ | _SECONDS


def contradicts(parameter: Parameter, taken: Taken) -> bool:
    """Whether the parameter has a unit of time or frequency other than `taken`; other units are not judged."""
    unit = parameter.unit.strip().lower()
    known = unit in _HERTZ or unit in _SECONDS or unit in _FREQUENCIES or unit in _TIMES
    return known and unit not in (_SECONDS if taken == "s" else _HERTZ)


def in_base_unit(parameter: Parameter) -> str:
    """Return the declaration with its default in s or Hz, as in `period = Param(0.1, unit="s")`."""
    unit = parameter.unit.strip().lower()
    factor = _FREQUENCIES.get(unit) or _TIMES.get(unit, 1.0)
    base = "Hz" if is_frequency(parameter) else "s"
    value = float(f"{parameter.default * factor:.12g}") if isinstance(parameter.default, (int, float)) else "..."
    return f'{parameter.name} = Param({value}, unit="{base}")'


def of_a_timer(parameter: Parameter, taken: Taken) -> str:
    """Return a complaint about a timer's period or frequency; "" if the parameter's unit is right, or unknown."""
    if not contradicts(parameter, taken):
        return ""
    name, unit, meant = parameter.name, parameter.unit, f"@timer({parameter.name})"
    is_hz = is_frequency(parameter)
    way = f"@timer(hz={name})" if is_hz else meant
    if not is_base(parameter):
        way = in_base_unit(parameter) if is_hz == (taken == "Hz") else f"{in_base_unit(parameter)} and {way}"
    takes = "a period is in seconds" if taken == "s" else "hz= is in Hz"
    return f"@timer: {takes}, and the parameter {name!r} is in {unit}; write {way}"
