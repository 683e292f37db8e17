"""Checks of the values that fields of strict messages accept, with rosidl's error texts.

A sequence of numbers accepts anything that Python converts to them, as in ROS 2: integers become floats. A field of one
number accepts only its own type: ROS 2 aborts the process when it publishes a message with any other.

Source: the setters that rosidl_generator_py generates, and their error texts.
"""

from __future__ import annotations

import math
from array import array
from collections import UserList
from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet
from contextlib import suppress
from typing import Any

from graphflow.wire.schema import INTEGER_RANGES, STRINGS, FieldType

Check = Callable[..., object]
"""Returns the value to store; raises AssertionError for one that does not fit."""

SEQUENCE_CODES = {
    "float32": "f",
    "float64": "d",
    "int8": "b",
    "uint8": "B",
    "char": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
}
"""Numeric types whose sequences are stored as `array.array`, by type code; their fixed arrays are NumPy arrays."""
WORDS = {"float64": "double", "float32": "float", "bool": "boolean", "byte": "octet", "char": "uint8"}
"""rosidl's names of some basic types."""
_FLOAT32 = 3.402823466e38


def rosidl_type(type_: FieldType) -> str:
    """Return a field's type in rosidl's notation: `sequence<double, 3>`."""
    base = WORDS.get(type_.base, type_.base.replace("/msg/", "/"))
    if type_.string_bound:
        base = f"{base}<{type_.string_bound}>"
    match type_.array:
        case "fixed":
            return f"{base}[{type_.size}]"
        case "bounded":
            return f"sequence<{base}, {type_.size}>"
        case "unbounded":
            return f"sequence<{base}>"
    return base


def checker(name: str, type_: FieldType, cls: type | None) -> Check:
    """Return the check for the values of a field.

    Args:
        cls: The message class, for fields of messages.
    """
    return _sequence(name, type_, cls) if type_.array else _single(name, type_, cls)


def lenient(check: Check) -> Check:
    """Return a check that also accepts values that do not fit."""

    def keep(value: Any) -> object:
        try:
            return check(value)
        except AssertionError:
            return value

    return keep


def _single(name: str, type_: FieldType, cls: type | None) -> Check:
    base = type_.base
    if cls is not None:
        return _kind(cls, f"The '{name}' field must be a sub message of type '{cls.__name__}'")
    if base == "bool":
        return _kind(bool, f"The '{name}' field must be of type 'bool'")
    if base == "byte":
        return _byte(name)
    if base in STRINGS:
        return _string(name, type_.string_bound)
    if base in INTEGER_RANGES:
        return _integer(name, base)
    if base == "float32":
        return _float32(name)
    return _kind(float, f"The '{name}' field must be of type 'float'")


def _kind(cls: type, complaint: str) -> Check:
    def check(value: Any) -> object:
        if not isinstance(value, cls):
            raise AssertionError(complaint)
        return value

    return check


def _byte(name: str) -> Check:
    def check(value: Any) -> bytes:
        if not isinstance(value, (bytes, bytearray)) or len(value) != 1:
            raise AssertionError(f"The '{name}' field must be of type 'bytes' or 'ByteString' with length 1")
        return bytes(value)

    return check


def _string(name: str, bound: int) -> Check:
    def check(value: Any) -> str:
        if not isinstance(value, str):
            raise AssertionError(f"The '{name}' field must be of type 'str'")
        if bound and len(value) > bound:
            raise AssertionError(f"The '{name}' field must be string value not longer than {bound}")
        return value

    return check


def _integer(name: str, base: str) -> Check:
    low, high = INTEGER_RANGES[base]
    kind = "an unsigned integer" if low == 0 else "an integer"

    def check(value: Any) -> int:
        if not isinstance(value, int):
            raise AssertionError(f"The '{name}' field must be of type 'int'")
        if not low <= value <= high:
            raise AssertionError(f"The '{name}' field must be {kind} in [{low}, {high}]")
        return value

    return check


def _float32(name: str) -> Check:
    def check(value: Any) -> float:
        if not isinstance(value, float):
            raise AssertionError(f"The '{name}' field must be of type 'float'")
        if abs(value) > _FLOAT32 and not math.isinf(value):
            raise AssertionError(f"The '{name}' field must be a float in [-{_FLOAT32}, {_FLOAT32}]")
        return value

    return check


def _sequence(name: str, type_: FieldType, cls: type | None) -> Check:
    element = _single(name, type_._replace(array="", size=0), cls)
    size = type_.size
    length = {"fixed": f" with length {size}", "bounded": f" with length <= {size}"}.get(type_.array, "")
    word = cls.__name__ if cls is not None else _python_name(type_.base)
    complaint = f"The '{name}' field must be a set or sequence{length} and each value of type '{word}'"

    def fits(count: int) -> bool:
        return count == size if type_.array == "fixed" else not size or count <= size

    def plain(value: Any) -> list[Any]:
        if not _is_sequence(value) or not fits(len(value)):
            raise AssertionError(complaint)
        items = list(value)
        try:
            for item in items:
                element(item)
        except AssertionError as error:
            within = str(error).partition(" in [")[2]
            raise AssertionError(f"{complaint}{f' in [{within}' if within else ''}") from None
        return items

    if type_.base not in SEQUENCE_CODES:
        # A list is kept as it is: whoever has it may change it, as in ROS 2.
        return lambda value: (plain(value), value)[1] if isinstance(value, list) else plain(value)
    code = SEQUENCE_CODES[type_.base]
    if type_.array == "fixed":
        return lambda value: _fixed(type_, value, plain)

    return _numbers(code, fits, plain)


def _numbers(code: str, fits: Callable[[int], bool], plain: Callable[[object], list[Any]]) -> Check:
    """Return the check for a sequence of numbers of variable length, stored as an `array` of a type code."""

    def numbers(value: Any) -> array[Any]:
        if isinstance(value, array) and value.typecode == code and fits(len(value)):
            return value
        if isinstance(value, (str, *(() if code in "bB" else (bytes, bytearray)))):
            plain(value)  # raises: `array` would take each character, or the memory
        made: array[Any] | None = None
        with suppress(TypeError, ValueError, OverflowError):
            made = array(code, value)
        if made is None:
            made = array(code, plain(value))  # raises for the element that does not fit
        # `array('f')` makes infinity of a number that is too large; `plain` tells it from one that was given.
        if not fits(len(made)) or (code == "f" and any(map(math.isinf, made))):
            plain(value)
        return made

    return numbers


def _is_sequence(value: Any) -> bool:
    """Whether a value has elements; a NumPy scalar has its arrays' dtype, but none."""
    if hasattr(value, "dtype"):
        return getattr(value, "ndim", 1) > 0
    return isinstance(value, (Sequence, AbstractSet, UserList, array)) and not isinstance(value, str)


def _fixed(type_: FieldType, value: Any, plain: Check) -> object:
    """Return an array of fixed length as a NumPy array."""
    import numpy as np

    from graphflow.wire.cdr.arrays import DTYPES, ndarray

    dtype = DTYPES[type_.base]
    given = value
    if isinstance(value, (list, tuple, array)):
        with suppress(ValueError):  # of lists of several lengths
            given = np.asarray(value)
    if isinstance(given, ndarray) and given.size == type_.size:
        if given.dtype == dtype:
            return given
        if dtype.kind == "f" and given.dtype.kind in "iuf":
            return given.astype(dtype)
    return np.array(plain(value), dtype)


def _python_name(base: str) -> str:
    if base in STRINGS:
        return "str"
    if base in ("bool", "byte"):
        return {"bool": "bool", "byte": "bytes"}[base]
    return "int" if base in INTEGER_RANGES else "float"
