"""Corrections of a value that does not fit its field: `'2'` for a number, a number for a list."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from math import floor, isfinite
from typing import Any

from graphflow.msgs import base
from graphflow.times import Duration, Time
from graphflow.typographic import plain
from graphflow.wire import schema
from graphflow.wire.schema import INTEGER_RANGES, Field, FieldType

_TRUE, _FALSE = ("true", "yes", "on", "1"), ("false", "no", "off", "0")
_SPANS = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_RECENT = 1e8
"""Seconds since 1970, from which on a number is a time of day as `time.time()` gives it."""
_SHOWN = 60
"""Characters that a suggestion may have."""


def instead(type_: FieldType, value: Any, fields: Sequence[Field] = ()) -> str:
    """The end of a sentence on a value that does not fit: what to write, as in `; write 2.0`.

    Args:
        fields: Those of the message type that the field holds.

    Returns:
        The empty text where nothing suggests itself.
    """
    text = _array(type_, value) if type_.array else _one(type_, value, fields)
    return f"; write {text}" if text is not None and len(text) <= _SHOWN else ""


def _one(type_: FieldType, value: Any, fields: Sequence[Field]) -> str | None:
    if type_.base in _SPANS and type(value) in (int, float) and isfinite(value):
        return _span(type_, value)
    if not type_.is_primitive and fields and type(value) in (int, float) and fields[0].type.base == "float64":
        name = type_.base.rpartition("/")[2]
        return f"{{{fields[0].name}: {float(value)}}}, in Python {name}({fields[0].name}={float(value)})"
    if not type_.is_primitive:
        return _mapping(value, fields)
    if type(value) is list:
        return _scalar(type_, value[0]) if len(value) == 1 else None
    return _scalar(type_, value)


def _span(type_: FieldType, seconds: float) -> str:
    """A number of seconds as a time or a duration."""
    if type_.base == _SPANS[0] and seconds >= _RECENT:
        return "self.clock.now(), in a node"
    sec = floor(seconds)
    return f"{{sec: {sec}, nanosec: {round((seconds - sec) * 1e9)}}}"


def _array(type_: FieldType, value: Any) -> str | None:
    """A value, or the values of a list, as a list."""
    if type_.base in schema.STRINGS and isinstance(value, str):
        return f"[{value!r}]"
    if type_.base not in schema.NUMERIC:
        return None
    items = [_scalar(type_, item) for item in (value if type(value) is list else [value])]
    return None if None in items else f"[{', '.join(map(str, items))}]"


def _scalar(type_: FieldType, value: Any) -> str | None:
    """A value as a primitive type is written; None where that would be a guess."""
    if type_.base in schema.STRINGS:
        return repr(str(value)) if type(value) in (int, float) else None
    if type_.base == "bool":
        word = str(value).lower() if type(value) in (int, str) else ""
        return "true (in Python True)" if word in _TRUE else "false (in Python False)" if word in _FALSE else None
    if isinstance(value, (Time, Duration)):
        return ".nanoseconds behind it" if type_.base in INTEGER_RANGES else ".seconds behind it"
    if type(value) not in (int, float, bool, str):
        return None
    try:
        number = float(plain(value) if type(value) is str else value)
        whole = int(number)
    except (ValueError, OverflowError):  # text, or no finite number
        return None
    if type_.base not in INTEGER_RANGES:
        return str(number)
    low, high = INTEGER_RANGES[type_.base]
    fits = low <= whole <= high and abs(whole) < 2**53
    return str(whole) if whole == number and fits else None


def _mapping(value: Any, fields: Sequence[Field]) -> str | None:
    """The numbers of a list by the names of the fields; of anything else, the fields with zeros."""
    if not fields or isinstance(value, Mapping):
        return None
    numbers = value if type(value) is list and len(value) == len(fields) else [0] * len(fields)
    pairs = zip(fields, numbers, strict=True)
    items = [(f.name, _scalar(f.type, n) if f.type.is_primitive and not f.type.array else None) for f, n in pairs]
    return None if any(text is None for _, text in items) else f"{{{', '.join(f'{name}: {t}' for name, t in items)}}}"


def named(cls: type[base.Message], data: Any) -> str | None:
    """Values by the names of the fields that they are probably meant for, in their order; None if their number differs.

    Args:
        data: A value, a list of values, or a text with a word for each field.
    """
    fields = cls.SCHEMA.fields
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


def _flow(value: Any) -> str | None:
    """A value as YAML has it on one line."""
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
