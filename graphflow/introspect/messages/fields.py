"""Fields of messages by their paths: `linear.x`, `ranges[3]`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from graphflow.errors import UsageFault
from graphflow.msgs import registry
from graphflow.names import did_you_mean
from graphflow.wire.schema import FieldType

Path = list[str | int]
"""Names of fields and indexes of elements."""
_TEXTS = ("string", "wstring")


def field_path(text: str, type_name: str) -> Path:
    """Parse a path such as `a.b[0].c`, checked against the type.

    Raises:
        UsageFault: The type has no such field or element.
    """
    return _resolved(text, type_name)[0]


def number_path(text: str, type_name: str) -> Path:
    """Parse the path of a field that is a single number, as `field_path` does.

    Raises:
        UsageFault: The type has no such field or element, or it is not a number.
    """
    path, type_ = _resolved(text, type_name)
    if type_.array:
        raise UsageFault(f"{text} is a list; choose an element, as in {text}[0]")
    if not type_.is_primitive:
        fields = numbers(type_.base)
        hint = f"; choose a field, as in {text}.{fields[0]}" if fields else ""
        raise UsageFault(f"{text} is of type {type_.base}, not a number{hint}")
    if type_.base in _TEXTS:
        raise UsageFault(f"{text} is of type {type_.base}, not a number")
    return path


def numbers(type_name: str) -> list[str]:
    """Return the paths of all fields that are single numbers, outside arrays."""
    return list(_numbers(type_name, ""))


def value_at(message: Any, path: Path) -> Any:
    """Return the value of a message at a path.

    Raises:
        IndexError: A list of the message is too short.
    """
    for part in path:
        message = message[part] if isinstance(part, int) else getattr(message, part)
    return message


def _numbers(type_name: str, at: str) -> Iterator[str]:
    for field in registry.message_schema(type_name).fields:
        if field.type.array:
            continue
        if not field.type.is_primitive:
            yield from _numbers(field.type.base, f"{at}{field.name}.")
        elif field.type.base not in _TEXTS:
            yield f"{at}{field.name}"


def _resolved(text: str, type_name: str) -> tuple[Path, FieldType]:
    if not re.fullmatch(r"\w+(\[\d+\])?(\.\w+(\[\d+\])?)*", text):
        raise UsageFault(f"{text!r} is not a field of a message; write FIELD.FIELD or FIELD[0]")
    path: Path = []
    type_, at = FieldType(type_name), ""
    for word, index in re.findall(r"(\w+)(?:\[(\d+)\])?", text):
        type_ = _field_type(type_, at, word)
        at = f"{at}.{word}" if at else word
        path.append(word)
        if index:
            if not type_.array:
                raise UsageFault(f"{at} is of type {type_} and has no elements")
            type_, at = type_._replace(array="", size=0), f"{at}[{index}]"
            path.append(int(index))
    return path, type_


def _field_type(type_: FieldType, at: str, word: str) -> FieldType:
    """Return the type of field `word` of the value at path `at`, which has type `type_`."""
    if type_.array:
        raise UsageFault(f"{at} is a list; choose an element, as in {at}[0]")
    if type_.is_primitive:
        raise UsageFault(f"{at} is of type {type_} and has no field {word!r}")
    fields = {f.name: f.type for f in registry.message_schema(type_.base).fields}
    if word not in fields:
        raise UsageFault(f"{type_.base} has no field {word!r}{did_you_mean(word, fields)}")
    return fields[word]
