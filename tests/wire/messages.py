"""Messages to test with: every type there is, and random values for any of them, as plain data."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from msgspec import defstruct

from graphflow.msgs import base, registry
from graphflow.wire import idl
from graphflow.wire.cdr.codegen import Types
from graphflow.wire.schema import INTEGER_RANGES, FieldType, Interface, Message, Service, string_length

from .conftest import INTERFACES

if TYPE_CHECKING:
    import random

STRINGS = ["", "a", "hé€", "map", "\N{TURTLE}", "tab\tand\nline", "0123456789" * 3, "x" * 300]
WIDE = [*STRINGS, "\ud800", "\N{TURTLE}\N{TURTLE}"]
FLOATS = [0.0, -0.0, 1.0, -1.5, 1e-40, 3.0e38, float("inf"), float("-inf"), 0.1]


def definitions() -> dict[str, Interface]:
    """All bundled and all fixture interfaces by name."""
    found = {}
    for root in (registry.BUNDLED, INTERFACES):
        for kind in registry.KINDS:
            for file in sorted(root.glob(f"*/{kind}/*.{kind}")):
                name = f"{file.parent.parent.name}/{kind}/{file.stem}"
                found[name] = idl.parse(name, file.read_text(encoding="utf-8"))
    return found


def message_names() -> list[str]:
    """The names of all messages that are sent: those of .msg files, and the parts of services and actions."""
    names = []
    for name, found in definitions().items():
        if isinstance(found, Message):
            names.append(name)
            continue
        services = (found,) if isinstance(found, Service) else found.services
        wholes = {found.name, *(service.name for service in services)}
        names += [m.name for m in found.messages if m.name not in wholes]
    return names


def random_values(schema: Message, rng: random.Random) -> dict[str, Any]:
    """A message of the type as plain data."""
    return {field.name: _field(field.type, rng) for field in schema.fields}


def _field(type_: FieldType, rng: random.Random) -> Any:
    if not type_.array:
        return _single(type_, rng)
    most = type_.size if type_.array == "bounded" else 4
    return [_single(type_, rng) for _ in range(type_.size if type_.array == "fixed" else rng.randint(0, most))]


def _single(type_: FieldType, rng: random.Random) -> Any:
    if type_.base == "bool":
        return rng.random() < 0.5
    if type_.base in INTEGER_RANGES:
        low, high = INTEGER_RANGES[type_.base]
        return rng.choice([low, high, 0, 1, rng.randint(low, high)])
    if type_.base == "float64":
        return rng.choice([*FLOATS, rng.uniform(-1e9, 1e9), 1e300])
    if type_.base == "float32":
        return struct.unpack("<f", struct.pack("<f", rng.choice([*FLOATS, rng.uniform(-1e9, 1e9)])))[0]
    if type_.base == "string":
        return rng.choice(
            [s for s in STRINGS if not type_.string_bound or string_length("string", s) <= type_.string_bound]
        )
    if type_.base == "wstring":
        return rng.choice(
            [s for s in WIDE if not type_.string_bound or string_length("wstring", s) <= type_.string_bound]
        )
    return random_values(registry.message_schema(type_.base), rng)


def make(name: str, values: dict[str, Any]) -> base.Message:
    """The message that plain data describe."""
    message: base.Message = registry.interface_class(name)(**values)
    return message


def plain(value: Any) -> Any:
    """A message, or a field of one, as plain data again."""
    if isinstance(value, base.Message):
        return {f.name: plain(getattr(value, f.name)) for f in value.SCHEMA.fields}
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, list):
        return [plain(item) for item in value]
    return value


def types_of(schemas: Mapping[str, Any]) -> Types:
    """Messages of some schemas, in classes that check nothing."""

    @cache
    def message_class(name: str) -> type:
        return defstruct("Thing", [f.name for f in schemas[name].fields], namespace={"SCHEMA": schemas[name]})

    return Types(schemas.__getitem__, message_class, lambda message: message)
