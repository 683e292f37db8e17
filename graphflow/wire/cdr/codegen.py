"""The common part of the generated encoders and decoders: source text, and runs of numbers laid out by `struct`.

Positions count from the start of the payload, its 4-byte header included; alignment counts from after the header.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

from graphflow.wire.cdr.unchecked import unchecked_class
from graphflow.wire.schema import FieldType, Message

FORMATS = {
    "bool": "?",
    "byte": "B",
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
Order = Literal["<", ">"]
"""Byte order as `struct` and numpy write it."""

HEADER = 4
LITTLE = 0x0100
"""The header bytes 00 01 00 00 as a little-endian uint32: plain CDR, little-endian."""


Style = Literal["numpy", "list", "rosidl"]
"""The representation of fields: numeric arrays as numpy's; or as lists, for which numpy is not loaded; or all as in the
classes that rosidl generates for Python, where `x` is stored in `_x`, a byte is a `bytes` of length one, and
sequences of numbers are `array.array`."""


Parts = dict[str, Any]


class Types(NamedTuple):
    """The compiler's access to types other than the one it compiles."""

    schema: Callable[[str], Message]
    message_class: Callable[[str], type]
    checked: Callable[[Any], Any]
    """Copies a message with every value checked and converted; raises EncodeError naming the field."""
    style: Style = "numpy"
    """The representation of fields in the classes."""
    values: int = 20_000_000
    """Largest number of values in the lists of a decoded message, arrays of numbers left out. A byte of a payload can
    become an object: without a bound, a hundred megabytes from any peer would exhaust the memory."""

    @property
    def prefix(self) -> str:
        """The prefix of a field's name in the name of its attribute."""
        return "_" if self.style == "rosidl" else ""


def min_size(type_: FieldType, schema: Callable[[str], Message]) -> int:
    """Return the smallest encoded size of a value of the type, padding left out."""
    if type_.array in ("bounded", "unbounded") or type_.base in ("string", "wstring"):
        each = 4
        if type_.array == "fixed":
            return each * type_.size
        return each
    if type_.base in FORMATS:
        each = struct.calcsize(FORMATS[type_.base])
    else:
        each = sum(min_size(f.type, schema) for f in schema(type_.base).fields) or 1
    return each * (type_.size if type_.array == "fixed" else 1)


def value_count(type_: FieldType, schema: Callable[[str], Message]) -> int:
    """Return the number of values in one element of the type, itself included; a list in it counts as one."""
    if type_.array or type_.is_primitive:
        return 1
    return 1 + sum(value_count(f.type, schema) for f in schema(type_.base).fields)


class Item(NamedTuple):
    """One number of a run: its struct format, and the expression of its source or target. Format `x` has none."""

    format: str
    expression: str


def layout_of(items: list[Item], start: int, order: Order) -> struct.Struct:
    """Return the struct of a run that begins at position `start`."""
    text, position = str(order), start
    for item in items:
        size = struct.calcsize(item.format)
        pad = (HEADER - position) % size
        text += "x" * pad + item.format
        position += pad + size
    return struct.Struct(text)


class Code:
    """Source text under construction, the objects it refers to, and the run of numbers not yet written.

    Args:
        parts: The functions for types in lists, by name: each is written once, however often it is used.
    """

    def __init__(self, types: Types, order: Order, parts: Parts) -> None:
        self.types = types
        self.order = order
        self.parts = parts
        self.lines: list[str] = []
        self.names: dict[str, Any] = {}
        self.depth = 1
        self.run: list[Item] = []
        self.making: list[str] = []
        """Lines that create messages, for when all their values exist."""
        self.position: int | None = HEADER
        """The position in the payload while it is the same for all messages; then None."""
        self._count = 0

    def fresh(self, prefix: str) -> str:
        self._count += 1
        return f"{prefix}{self._count}"

    def constant(self, prefix: str, value: Any) -> str:
        name = self.fresh(prefix)
        self.names[name] = value
        return name

    def part(self, name: str, compile_part: Callable[[Message, Types, Parts], Any]) -> str:
        """Return the name of the function for a type in a list."""
        if name not in self.parts:
            self.parts[name] = compile_part(self.types.schema(name), self.types, self.parts)
        return self.constant("part", self.parts[name])

    def make(self, cls: type, values: list[str], target: str) -> None:
        """Plan the creation of a message from the values of its fields."""
        made = f"{self.constant('U', unchecked_class(cls))}({', '.join(values)})"
        self.making += [f"{target} = {made}", f"{target}.__class__ = {self.constant('C', cls)}"]

    def make_all(self) -> None:
        """Write the creation of the messages, inner ones first."""
        for text in self.making:
            self.line(text)

    def line(self, text: str) -> None:
        self.lines.append("    " * self.depth + text)

    def format_of(self, base: str) -> str:
        """Return the struct format of a number."""
        return "c" if base == "byte" and self.types.style == "rosidl" else FORMATS[base]

    def number(self, format_: str, expression: str) -> None:
        self.run.append(Item(format_, expression))

    def take_run(self, method: str) -> tuple[str, list[str], int | None] | None:
        """Return the struct of the run so far, its operands, and its size if that is fixed.

        The struct is an expression: of its bound `method` if the size is fixed, else of the struct itself.
        """
        if not self.run:
            return None
        items, self.run = self.run, []
        operands = [i.expression for i in items if i.format != "x"]
        widest = max(struct.calcsize(i.format) for i in items)
        if self.position is not None or widest == 1:
            layout = layout_of(items, self.position or 0, self.order)
            if self.position is not None:
                self.position += layout.size
            return self.constant("S", getattr(layout, method)), operands, layout.size
        # The size of the padding depends on the position modulo the widest number only.
        table = tuple(layout_of(items, start, self.order) for start in range(widest))
        return f"{self.constant('S', table)}[p & {widest - 1}]", operands, None

    def compile(self, name: str, head: str, label: str) -> Any:
        source = "\n".join([head, *self.lines])
        exec(compile(source, f"<{label}>", "exec"), self.names)  # noqa: S102 - written above from a checked schema
        return self.names[name]


def padding(widest: int) -> tuple[bytes, ...]:
    """Zero bytes that align position p to `widest`, by `p & (widest - 1)`."""
    return tuple(bytes((HEADER - p) % widest) for p in range(widest))
