"""Corrections of values that do not fit their field: `'2'` for a number, a number for a list."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from datetime import datetime
from math import floor, isfinite

from graphflow.errors import EncodeError
from graphflow.msgs import base
from graphflow.times import Duration, Time
from graphflow.typographic import plain
from graphflow.wire import schema
from graphflow.wire.schema import INTEGER_RANGES, Field, FieldType

_TRUE, _FALSE = ("true", "yes", "on", "1"), ("false", "no", "off", "0")
_SPANS = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_RECENT = 1e8
"""Seconds since 1970 from which on a number is read as a time of day, as from `time.time()`."""
_SHOWN = 60
"""Longest suggestion, in characters."""


def instead(type_: FieldType, value: object, fields: Sequence[Field] = ()) -> str:
    """Return advice on a value that does not fit, as in `; write 2.0`.

    Args:
        fields: The fields of the message type, if the field has one.

    Returns:
        The advice; empty if there is none.
    """
    text = _array(type_, value) if type_.array else _one(type_, value, fields)
    return f"; write {text}" if text is not None and len(text) <= _SHOWN else ""


def instead_of_rclpys(cls: type) -> str:
    """Return how to import graphflow's class in place of one of rclpy's; empty for any other class."""
    found = re.match(r"(\w+\.(?:msg|srv|action))\._", cls.__module__)
    return f"that class is rclpy's: write from graphflow.msgs.{found[1]} import {cls.__name__}" if found else ""


def in_its_message(type_: type[base.Message], value: object) -> str:
    """Return advice on a value that was given in place of a message with a single field; empty if there is none."""
    if way := instead_of_rclpys(type(value)):
        return f"; {way}"
    fields = type_.SCHEMA.fields
    if len(fields) != 1 or not isinstance(value, (str, int, float)):
        return ""
    name, shown = fields[0].name, "..."  # not the value, which may be another one next time
    try:
        type_(**{name: value}).to_bytes()
    except EncodeError:
        shown = "str(...)" if fields[0].type.base in schema.STRINGS else "..."
    return f"; write {type_.__name__}({name}={shown})"


def _one(type_: FieldType, value: object, fields: Sequence[Field]) -> str | None:
    number = _number(value)
    if type_.base in _SPANS and number is not None and isfinite(number):
        return _span(type_, number)
    if type_.base == _SPANS[0] and isinstance(value, (str, datetime)):
        return "{sec: 0, nanosec: 0}, in Python self.clock.now()"
    if not type_.is_primitive and fields and number is not None and fields[0].type.base == "float64":
        name = type_.base.rpartition("/")[2]
        part, turn = fields[0].name, ", or z for a turn" if name == "Vector3" else ""
        return f"{{{part}: {float(number)}}}, in Python {name}({part}={float(number)}){turn}"
    if not type_.is_primitive:
        if type(value) is not tuple:
            return _mapping(value, fields)
        text = _mapping(list(value), fields)
        name = type_.base.rpartition("/")[2]
        return None if text is None else f"{name}({text[1:-1].replace(': ', '=')})"
    if type(value) is list:
        return _scalar(type_, value[0]) if len(value) == 1 else None
    return _scalar(type_, value)


def _number(value: object) -> float | None:
    """Return a number of Python's own types; None for anything else, bools and NumPy's scalars included."""
    return value if isinstance(value, (int, float)) and type(value) in (int, float) else None


def _span(type_: FieldType, seconds: float) -> str:
    """Format a number of seconds as a time or a duration."""
    if type_.base == _SPANS[0] and seconds >= _RECENT:
        return "self.clock.now(), in a node"
    sec = floor(seconds)
    return f"{{sec: {sec}, nanosec: {round((seconds - sec) * 1e9)}}}"


def _array(type_: FieldType, value: object) -> str | None:
    """Format a value, or the values of a list, as a list."""
    if type_.base in schema.STRINGS and isinstance(value, str):
        return f"[{value!r}]"
    if type_.base not in schema.NUMERIC:
        return None
    items = [_scalar(type_, item) for item in (value if type(value) is list else [value])]
    return None if None in items else f"[{', '.join(map(str, items))}]"


def _scalar(type_: FieldType, value: object) -> str | None:
    """Format a value as its primitive type requires; None where that would be a guess."""
    if type_.base in schema.STRINGS:
        return repr(str(value)) if type(value) in (int, float) else None
    if type_.base == "bool":
        text = str(value).lower() if type(value) in (int, str) else ""
        return "true (in Python True)" if text in _TRUE else "false (in Python False)" if text in _FALSE else None
    if isinstance(value, (Time, Duration)):
        return ".nanoseconds behind it" if type_.base in INTEGER_RANGES else ".seconds behind it"
    if not isinstance(value, (int, float, str)) or type(value) not in (int, float, bool, str):
        return None  # a subclass of them, such as NumPy's float64, may print as anything
    try:
        number = float(plain(value) if isinstance(value, str) else value)
        whole = int(number)
    except (ValueError, OverflowError):  # not a number, or not finite
        return None
    if type_.base not in INTEGER_RANGES:
        return str(number)
    low, high = INTEGER_RANGES[type_.base]
    fits = low <= whole <= high and abs(whole) < 2**53
    return str(whole) if whole == number and fits else None


def _mapping(value: object, fields: Sequence[Field]) -> str | None:
    """Assign the numbers of a list to the names of the fields; for any other value, give the fields with zeros."""
    if not fields or isinstance(value, Mapping):
        return None
    numbers = value if type(value) is list and len(value) == len(fields) else [0] * len(fields)
    pairs = zip(fields, numbers, strict=True)
    items = [(f.name, _scalar(f.type, n) if f.type.is_primitive and not f.type.array else None) for f, n in pairs]
    return None if any(text is None for _, text in items) else f"{{{', '.join(f'{name}: {t}' for name, t in items)}}}"


def named(cls: type[base.Message], data: object) -> str | None:
    """Assign values to the fields that they are probably meant for, in order; None if their number differs.

    Args:
        data: A value, a list of values, or a text with a part for each field, as in `1 2` or `x=1 y=2`.
    """
    fields = cls.SCHEMA.fields
    pairs = [part.partition("=") for part in data.split()] if isinstance(data, str) else []
    if pairs and all(sign and name in {field.name for field in fields} for name, sign, _ in pairs):
        return f"{{{', '.join(f'{name}: {_flow(value)}' for name, _, value in pairs)}}}"
    values = data if isinstance(data, list) else data.split() if isinstance(data, str) and len(fields) > 1 else [data]
    if len(values) != len(fields) or not fields:
        return None
    parts = []
    for field, value in zip(fields, values, strict=True):
        nested = None if field.type.is_primitive or field.type.array else cls.NESTED[field.type.base]
        text = _flow(value) if nested is None else named(nested, value) if isinstance(value, list) else None
        if text is None:
            return None
        parts.append(f"{field.name}: {text}")
    return f"{{{', '.join(parts)}}}"


def _flow(value: object) -> str | None:
    """Format a value as YAML on one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        needs_none = _NEEDS_NO_QUOTES.fullmatch(value)
        return value if needs_none else "'" + value.replace("'", "''") + "'"
    if isinstance(value, list):
        items = list(map(_flow, value))
        return None if None in items else f"[{', '.join(map(str, items))}]"
    return repr(value) if isinstance(value, (int, float)) else None


_NEEDS_NO_QUOTES = re.compile(r"[\w./+-][\w ./+-]*")
