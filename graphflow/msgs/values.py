"""Conversion of values for the fields of messages: checked against the field's type, and converted without loss."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from graphflow.errors import EncodeError
from graphflow.msgs import base
from graphflow.msgs.instead import instead, named
from graphflow.names import did_you_mean
from graphflow.wire import schema
from graphflow.wire.cdr.unchecked import unchecked
from graphflow.wire.schema import INTEGER_RANGES, Field, FieldType

Nested = Mapping[str, type[base.Message]]
"""Classes of nested message types, by name."""


def convert(field: Field, value: object, owner: base.Message) -> Any:
    """Convert `value` to the field's type.

    Raises:
        EncodeError: `value` does not fit; the text begins with `Type.field`.
    """
    try:
        return _value(field.type, value, owner.NESTED)
    except _Wrong as wrong:
        path = f"{type(owner).__name__}.{field.name}{wrong.path}"
        raise EncodeError(f"{path}: {wrong.reason}") from None


_FLOAT32_END = 3.4028235677973366e38
"""Smallest number that rounds to infinity as a float32."""


class _Wrong(Exception):
    def __init__(self, reason: str, path: str = "") -> None:
        self.reason, self.path = reason, path


def _value(type_: FieldType, value: object, nested: Nested) -> Any:
    if type_.array:
        return _array(type_, value, nested)
    if type_.is_primitive:
        return _scalar(type_, value)
    return _nested(type_, nested[type_.base], value)


def _nested(type_: FieldType, cls: type[base.Message], value: object) -> object:
    if value.__class__ is cls:
        return value
    fields = [f.name for f in cls.SCHEMA.fields]
    if isinstance(value, Mapping):
        for key in value:
            if key not in fields:
                raise _Wrong(f"{cls.SCHEMA.name} has no field {key!r}{did_you_mean(str(key), fields)}")
        values = dict(value)
    elif fields and not isinstance(value, base.Message) and all(hasattr(value, f) for f in fields):
        values = {f: getattr(value, f) for f in fields}
    else:
        raise _Wrong(f"expected {cls.SCHEMA.name}, got {value!r}{instead(type_, value, cls.SCHEMA.fields)}")
    try:
        return cls(**values)
    except EncodeError as error:
        path, _, reason = str(error).partition(": ")
        raise _Wrong(reason, path.removeprefix(cls.__name__)) from None


def _array(type_: FieldType, value: Any, nested: Nested) -> Any:
    if isinstance(value, (str, Mapping)) or not hasattr(value, "__len__") or getattr(value, "shape", None) == ():
        raise _Wrong(f"expected {type_}, got {value!r}{instead(type_, value)}")
    element = type_._replace(array="", size=0)
    if type_.base in schema.NUMERIC:
        from graphflow.wire.cdr.arrays import as_array

        try:
            array = as_array(value, type_.base)
        except (ValueError, TypeError) as error:
            if isinstance(value, (list, tuple)):
                _items(element, value, nested)  # raises with the element that does not fit
            raise _Wrong(f"{error}{instead(type_, value)}") from None
        _check_count(type_, array.size)
        return array
    _check_count(type_, len(value))
    return _items(element, value, nested)


def _items(element: FieldType, value: Iterable[object], nested: Nested) -> list[object]:
    items = []
    for i, item in enumerate(value):
        try:
            items.append(_value(element, item, nested))
        except _Wrong as wrong:
            raise _Wrong(wrong.reason, f"[{i}]{wrong.path}") from None
    return items


def _check_count(type_: FieldType, count: int) -> None:
    if type_.array == "fixed" and count != type_.size:
        raise _Wrong(f"expected {type_.size} elements ({type_}), got {count}")
    if type_.array == "bounded" and count > type_.size:
        raise _Wrong(f"expected at most {type_.size} elements ({type_}), got {count}")


def _scalar(type_: FieldType, value: Any) -> object:
    name = type_.base
    if name in schema.STRINGS:
        return _string(type_, value)
    if name in ("byte", "char") and isinstance(value, bytes) and len(value) == 1:
        return value[0]
    kind = _kind(value)
    if name == "bool" and kind == "bool":
        return bool(value)
    if name in INTEGER_RANGES and kind == "int":
        low, high = INTEGER_RANGES[name]
        if not low <= value <= high:
            raise _Wrong(f"{value} does not fit {name}: {low} to {high}")
        return int(value)
    if name in ("float32", "float64") and kind in ("int", "float"):
        return _float(name, value)
    raise _Wrong(f"expected {name}, got {value!r}{instead(type_, value)}")


def _string(type_: FieldType, value: object) -> str:
    name = type_.base
    if not isinstance(value, str):
        raise _Wrong(f"expected {name}, got {value!r}{instead(type_, value)}")
    try:
        length = schema.string_length(name, value)
    except UnicodeEncodeError:
        raise _Wrong(f"{value!r} is not valid Unicode") from None
    if type_.string_bound and length > type_.string_bound:
        unit = "bytes of UTF-8" if name == "string" else "UTF-16 code units"
        raise _Wrong(f"expected at most {type_.string_bound} {unit} ({type_}), got {length}")
    return value


def _float(name: str, value: float) -> float:
    try:
        number = float(value)
    except OverflowError:
        raise _Wrong(f"{value} is too large for {name}") from None
    if name == "float32" and _FLOAT32_END <= abs(number) != float("inf"):
        raise _Wrong(f"{value!r} is too large for float32")
    return number


def _kind(value: object) -> str:
    """Return `bool`, `int`, `float` or another type, by which NumPy's scalars count, too."""
    if isinstance(value, bool):
        return "bool"
    if isinstance(value, int):
        return "int"
    if isinstance(value, float):
        return "float"
    kind = getattr(getattr(value, "dtype", None), "kind", "") if getattr(value, "shape", None) == () else ""
    return {"b": "bool", "i": "int", "u": "int", "f": "float"}.get(kind, "other")


def from_plain(cls: type[base.Message], data: object) -> base.Message:
    """Create a message from plain values, as in YAML: a mapping of field names, or None for all defaults.

    Raises:
        EncodeError: A field does not exist or its value does not fit; the text names the field.
    """
    if data is None:
        data = {}
    fields = [f.name for f in cls.SCHEMA.fields]
    if not isinstance(data, Mapping):
        example = f"{{{fields[0]}: ...}}" if fields else "{}"
        way = f"as a mapping, for example {example}"
        if (meant := named(cls, data)) is not None:
            way = f"with the names of its fields, as in {meant}"
        raise EncodeError(f"{cls.SCHEMA.name} is written {way}; got {data!r}")
    for key in data:
        if key not in fields:
            raise EncodeError(f"{cls.SCHEMA.name} has no field {key!r}{did_you_mean(str(key), fields)}")
    return cls(**data)


def checked(message: base.Message) -> base.Message:
    """Return a copy with all values, nested ones included, checked and converted.

    Raises:
        EncodeError: A value is wrong; the text gives the path of the first.
    """
    if not isinstance(message, base.Message):
        raise EncodeError(f"expected a message, got {message!r}")
    try:
        return _checked(message)
    except _Wrong as wrong:
        raise EncodeError(f"{type(message).__name__}{wrong.path}: {wrong.reason}") from None


def _checked(message: base.Message) -> base.Message:
    values = []
    for field in message.SCHEMA.fields:
        if not hasattr(message, field.name):
            raise _Wrong("was deleted", f".{field.name}")
        try:
            values.append(_checked_value(field.type, getattr(message, field.name), message.NESTED))
        except _Wrong as wrong:
            raise _Wrong(wrong.reason, f".{field.name}{wrong.path}") from None
    result: base.Message = unchecked(type(message), *values)
    return result


def _checked_value(type_: FieldType, value: Any, nested: Nested) -> Any:
    if isinstance(value, base.Message) and not type_.is_primitive and not type_.array:
        if value.SCHEMA.name != type_.base:
            raise _Wrong(f"expected {type_.base}, got {value!r}")
        return _checked(value)
    converted = _value(type_, value, nested)
    if type_.array and not type_.is_primitive:
        items = []
        for i, item in enumerate(converted):
            try:
                items.append(_checked(item))
            except _Wrong as wrong:
                raise _Wrong(wrong.reason, f"[{i}]{wrong.path}") from None
        return items
    return converted
