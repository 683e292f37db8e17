"""Definitions from other processes and bags: type descriptions converted to text, and checks before texts are used.

Nothing in them is trusted: names and sizes go through the parser of definitions, and together they must have the
announced hash.

Source: type_description_interfaces (REP-2016); RIHS01.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from graphflow.errors import InterfaceError
from graphflow.wire import idl
from graphflow.wire.extent import extent
from graphflow.wire.schema import Action, FieldType, Interface, Message, Service
from graphflow.wire.typehash import HIDDEN, Lookup, base_of, referenced, type_hash

DESCRIBING = "type_description_interfaces/srv/GetTypeDescription"
"""The service that returns a node's type definitions."""
TYPES_BOUND = 500
"""Largest number of types that one definition may need."""
LINE_BOUND = 1000
"""Longest line without its comment, in characters."""
TEXT_BOUND = 300_000
"""Largest total of their texts, in characters."""
FIELDS_BOUND = 20_000
"""Largest number of fields of a type with its nested types, counted wherever used. The largest of ROS 2's own types has
a thirtieth of that; writing the code for as many takes about a second."""
FIXED_BOUND = 1_000_000
"""Largest number of values in arrays of fixed size, which an empty message contains, too."""
VALUES_BOUND = 2_000_000
"""Largest number of values in the lists of a message of such a type, arrays of numbers left out."""
_BY_HAND = "if that is intended, put its files into interfaces/"


class DescribedField(NamedTuple):
    """A field of a type description: type_description_interfaces/msg/Field and FieldType."""

    name: str
    type_id: int
    capacity: int
    string_capacity: int
    nested_type_name: str


def definition_of(name: str, fields: list[DescribedField]) -> str:
    """Return the text of a message's definition file. Type descriptions have no defaults and constants.

    Raises:
        InterfaceError: A field has an unknown type.
    """
    # A type without fields is described with this one field.
    if [f.name for f in fields] == [HIDDEN]:
        return ""
    return "".join(f"{_type(name, field)} {field.name}\n" for field in fields)


def _type(name: str, field: DescribedField) -> FieldType:
    found = base_of(field.type_id)
    if found is None:
        raise InterfaceError(f"{name}: field {field.name!r} is of the unknown type {field.type_id}")
    base, array = found
    # 21 and 22 are bounded strings, and each kind of array adds 48 (`typehash`).
    bound = field.string_capacity if field.type_id % 48 in (21, 22) else 0
    size = field.capacity if array in ("fixed", "bounded") else 0
    return FieldType(base or field.nested_type_name, bound, array, size)


def verified(name: str, digest: str, sources: Mapping[str, str]) -> dict[str, Interface]:
    """Check the definition of a type and of its nested types; returns exactly their interfaces.

    Args:
        name: `package/kind/Name`.
        digest: The hash that it must have; empty for any.
        sources: The definition texts of the type and of its nested types, by type.

    Raises:
        InterfaceError: They are wrong, too large, incomplete, or of another hash.
    """
    if len(sources) > TYPES_BOUND or sum(map(len, sources.values())) > TEXT_BOUND:
        raise InterfaceError(f"{name}: its definition is too large")
    if any(len(type_.split("/")) != 3 or type_.split("/")[1] not in ("msg", "srv", "action") for type_ in sources):
        raise InterfaceError(f"{name}: its definition has an illegal type name")
    if any(len(line.partition("#")[0]) > LINE_BOUND for text in sources.values() for line in text.splitlines()):
        raise InterfaceError(f"{name}: its definition has a line that is too long")
    found = {type_: idl.parse(type_, text) for type_, text in sources.items()}
    messages = {m.name: m for interface in found.values() for m in _messages(interface)}

    def lookup(type_: str) -> Message:
        if type_ not in messages:
            raise InterfaceError(f"{name}: its definition lacks {type_}")
        return messages[type_]

    whole = lookup(name)
    _refuse_size(name, lookup)
    actual = type_hash(whole, lookup)
    if digest and actual != digest:
        raise InterfaceError(f"{name}: its definition has the hash {actual}, not {digest}, which was announced")
    needed = {name, *referenced(whole, lookup)}
    return {type_: interface for type_, interface in found.items() if needed & {m.name for m in _messages(interface)}}


def _messages(interface: Interface) -> tuple[Message, ...]:
    return interface.messages if isinstance(interface, (Service, Action)) else (interface,)


def _refuse_size(name: str, lookup: Lookup) -> None:
    """Refuse types whose code, or whose empty messages, would exhaust the memory."""
    size = extent(name, lookup)
    if size.fields > FIELDS_BOUND:
        raise InterfaceError(f"{name}: with its nested types, it has more than {FIELDS_BOUND:,} fields; {_BY_HAND}")
    if size.values > FIXED_BOUND:
        raise InterfaceError(f"{name}: an empty message would have more than {FIXED_BOUND:,} values; {_BY_HAND}")
