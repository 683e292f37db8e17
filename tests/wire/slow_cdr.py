"""The codec's twin: CDR written one value at a time, to be read and not to be fast.

Messages are plain data here: a dict of field values, a list for any array, Python's own numbers and strings. The
encoder also tells which bytes are padding, whose values no CDR writer promises.

Source: OMG formal/02-06-51 chapter 15.3; ROS 2's additions: a wstring is UTF-16 units as uint32, a message without
fields is one zero byte.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal

from graphflow.wire.schema import Message

if TYPE_CHECKING:
    from graphflow.wire.schema import FieldType

Lookup = Callable[[str], Message]
Order = Literal["<", ">"]

NUMBERS = {
    "bool": ("?", 1),
    "byte": ("B", 1),
    "char": ("B", 1),
    "int8": ("b", 1),
    "uint8": ("B", 1),
    "int16": ("h", 2),
    "uint16": ("H", 2),
    "int32": ("i", 4),
    "uint32": ("I", 4),
    "int64": ("q", 8),
    "uint64": ("Q", 8),
    "float32": ("f", 4),
    "float64": ("d", 8),
}


class Writer:
    """A payload under construction; `padding[i]` is whether byte i is padding."""

    def __init__(self, lookup: Lookup, order: Order = "<") -> None:
        self.lookup = lookup
        self.order = order
        self.payload = bytearray(b"\0\1\0\0" if order == "<" else b"\0\0\0\0")
        self.padding = [False] * 4

    def put(self, data: bytes, padding: bool = False) -> None:
        self.payload += data
        self.padding += [padding] * len(data)

    def number(self, base: str, value: Any) -> None:
        letter, size = NUMBERS[base]
        while (len(self.payload) - 4) % size:
            self.put(b"\0", padding=True)
        self.put(struct.pack(self.order + letter, value))

    def message(self, schema: Message, values: dict[str, Any]) -> None:
        if not schema.fields:
            self.put(b"\0")
        for field in schema.fields:
            self.field(field.type, values[field.name])

    def field(self, type_: FieldType, value: Any) -> None:
        if not type_.array:
            self.single(type_, value)
            return
        if type_.array != "fixed":
            self.number("uint32", len(value))
        for item in value:
            self.single(type_, item)

    def single(self, type_: FieldType, value: Any) -> None:
        if type_.base == "string":
            text = value.encode() + b"\0"
            self.number("uint32", len(text))
            self.put(text)
        elif type_.base == "wstring":
            units = value.encode("utf-16-le", "surrogatepass")
            self.number("uint32", len(units) // 2)
            for i in range(0, len(units), 2):
                self.number("uint32", units[i] + 256 * units[i + 1])
        elif type_.base in NUMBERS:
            self.number(type_.base, value)
        else:
            self.message(self.lookup(type_.base), value)


class Reader:
    """A payload being read; anything wrong with it is some exception or other."""

    def __init__(self, lookup: Lookup, payload: bytes) -> None:
        self.lookup = lookup
        self.payload = payload
        self.order = "<" if payload[1] else ">"
        self.position = 4

    def number(self, base: str) -> Any:
        letter, size = NUMBERS[base]
        while (self.position - 4) % size:
            self.position += 1
        (value,) = struct.unpack_from(self.order + letter, self.payload, self.position)
        self.position += size
        return value

    def message(self, schema: Message) -> dict[str, Any]:
        if not schema.fields:
            self.position += 1
        return {field.name: self.field(field.type) for field in schema.fields}

    def field(self, type_: FieldType) -> Any:
        if not type_.array:
            return self.single(type_)
        count = type_.size if type_.array == "fixed" else self.number("uint32")
        return [self.single(type_) for _ in range(count)]

    def single(self, type_: FieldType) -> Any:
        if type_.base == "string":
            count = self.number("uint32")
            text = self.payload[self.position : self.position + count]
            self.position += count
            return text[:-1].decode()
        if type_.base == "wstring":
            units = [self.number("uint32") for _ in range(self.number("uint32"))]
            return b"".join(struct.pack("<H", u) for u in units).decode("utf-16-le", "surrogatepass")
        if type_.base in NUMBERS:
            return self.number(type_.base)
        return self.message(self.lookup(type_.base))


def encode(schema: Message, values: dict[str, Any], lookup: Lookup, order: Order = "<") -> tuple[bytes, list[bool]]:
    """A message's payload, and for each byte whether it is padding."""
    writer = Writer(lookup, order)
    writer.message(schema, values)
    return bytes(writer.payload), writer.padding


def decode(schema: Message, payload: bytes, lookup: Lookup) -> dict[str, Any]:
    """The values of a payload of either byte order."""
    return Reader(lookup, payload).message(schema)


def masked(payload: bytes, padding: list[bool]) -> bytes:
    """A payload with its padding zeroed; bytes after the end of the message are left out."""
    return bytes(0 if is_padding else byte for byte, is_padding in zip(payload, padding, strict=False))
