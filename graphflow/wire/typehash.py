"""RIHS01: the hash of a type's description, part of every key and token.

Source: REP-2011; rosidl_generator_type_description. Defaults, constants and comments are not hashed.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable

from graphflow.wire.schema import FieldType, Message

PREFIX = "RIHS01_"
HIDDEN = "structure_needs_at_least_one_member"
"""The field that describes a type without fields."""

_IDS = {
    "int8": 2,
    "uint8": 3,
    "char": 3,
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
    "wstring": 18,
}
_BOUNDED_STRING_IDS = {"string": 21, "wstring": 22}
# `char` has the number of `uint8`, which is what is read back.
_BASES = {number: base for base, number in (*_IDS.items(), *_BOUNDED_STRING_IDS.items()) if base != "char"}
_ARRAY_OFFSETS = {"": 0, "fixed": 48, "bounded": 96, "unbounded": 144}

Lookup = Callable[[str], Message]
"""Returns the schema of `package/msg/Name`."""


def type_id(type_: FieldType) -> int:
    """Return the number of a field type, as in type_description_interfaces/msg/FieldType."""
    base = _BOUNDED_STRING_IDS[type_.base] if type_.string_bound else _IDS.get(type_.base, 1)
    return base + _ARRAY_OFFSETS[type_.array]


def base_of(number: int) -> tuple[str, str] | None:
    """Invert `type_id`: return the base, empty for a nested type, and the kind of array; None for an unknown number.

    A `char` is described as a `uint8`, and read back as one.
    """
    kinds = [kind for kind, offset in _ARRAY_OFFSETS.items() if offset // 48 == number // 48]
    base = "" if number % 48 == 1 else _BASES.get(number % 48)
    return (base, kinds[0]) if kinds and base is not None and number >= 0 else None


def _describe(message: Message) -> dict[str, object]:
    fields: Iterable[tuple[str, FieldType]] = [(f.name, f.type) for f in message.fields]
    # A type without fields is described, and encoded, as one hidden byte.
    fields = fields or [(HIDDEN, FieldType("uint8"))]
    return {
        "type_name": message.name,
        "fields": [
            {
                "name": name,
                "type": {
                    "type_id": type_id(t),
                    "capacity": t.size,
                    "string_capacity": t.string_bound,
                    "nested_type_name": "" if t.is_primitive else t.base,
                },
            }
            for name, t in fields
        ],
    }


def referenced(message: Message, lookup: Lookup) -> dict[str, Message]:
    """Return every type that is reachable from `message`, without itself, by name."""
    found: dict[str, Message] = {}
    todo = [message]
    while todo:
        for field in todo.pop().fields:
            name = field.type.base
            if not field.type.is_primitive and name not in found and name != message.name:
                found[name] = lookup(name)
                todo.append(found[name])
    return found


def type_description(message: Message, lookup: Lookup) -> str:
    """Return the JSON text that is hashed."""
    others = referenced(message, lookup)
    # The hash is over exactly this text: default separators, ASCII escapes, this order of keys, types by name.
    return json.dumps(
        {
            "type_description": _describe(message),
            "referenced_type_descriptions": [_describe(others[name]) for name in sorted(others)],
        }
    )


def type_hash(message: Message, lookup: Lookup) -> str:
    """Return `RIHS01_` and 64 hex digits."""
    return PREFIX + hashlib.sha256(type_description(message, lookup).encode()).hexdigest()
