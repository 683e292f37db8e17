"""What writing an encoder and writing a decoder have in common: source text, and runs of numbers laid out by `struct`.

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
"""Byte order in `struct`'s and numpy's spelling."""

HEADER = 4
LITTLE = 0x0100
"""The header bytes 00 01 00 00 read as a little-endian uint32: plain CDR, little-endian."""


Style = Literal["numpy", "list", "rosidl"]
"""How messages hold their fields: numeric arrays as numpy's; or as lists, for which numpy is not loaded; or all as in
the classes that rosidl generates for Python, where `x` is kept in `_x`, a byte is a `bytes` of length one, and
sequences of numbers are `array.array`."""


Parts = dict[str, Any]


class Types(NamedTuple):
    """What the compiler needs to know about types other than the one at hand."""

    schema: Callable[[str], Message]
    message_class: Callable[[str], type]
    checked: Callable[[Any], Any]
    """A copy of a message with every value checked and converted; raises EncodeError naming the field."""
    style: Style = "numpy"
    """How the classes hold their fields."""
    values: int = 20_000_000
    """Values that the lists of a decoded message may have, arrays of numbers left out. A byte of a payload can become
    an object: without a bound, a hundred megabytes from anybody would take all memory."""

    @property
    def prefix(self) -> str:
        """What comes before a field's name in that of the attribute."""
        return "_" if self.style == "rosidl" else ""


def min_size(type_: FieldType, schema: Callable[[str], Message]) -> int:
    """The fewest bytes a value of the type can take on the wire, padding left out."""
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
    """The values that one element of the type has, itself included; a list in it counts as one."""
    if type_.array or type_.is_primitive:
        return 1
    return 1 + sum(value_count(f.type, schema) for f in schema(type_.base).fields)


class Item(NamedTuple):
    """One number of a run: its struct format and the expression it comes from or goes to. Format `x` has none."""

    format: str
    expression: str


def layout_of(items: list[Item], start: int, order: Order) -> struct.Struct:
    """The struct that holds a run which begins at position `start`."""
    text, position = str(order), start
    for item in items:
        size = struct.calcsize(item.format)
        pad = (HEADER - position) % size
        text += "x" * pad + item.format
        position += pad + size
    return struct.Struct(text)


class Code:
    """Source text under construction, the objects it refers to, and the run of numbers not yet written out.

    Args:
        parts: The functions for types that are in lists, by name: each is written once, however often it is used.
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
        """Lines that make messages of values, once all values are there."""
        self.position: int | None = HEADER
        """The code's position in the payload, while that is the same for all messages; then None."""
        self._count = 0

    def fresh(self, prefix: str) -> str:
        self._count += 1
        return f"{prefix}{self._count}"

    def constant(self, prefix: str, value: Any) -> str:
        name = self.fresh(prefix)
        self.names[name] = value
        return name

    def part(self, name: str, compile_part: Callable[[Message, Types, Parts], Any]) -> str:
        """The name of the function for a type that is in a list."""
        if name not in self.parts:
            self.parts[name] = compile_part(self.types.schema(name), self.types, self.parts)
        return self.constant("part", self.parts[name])

    def make(self, cls: type, values: list[str], target: str) -> None:
        """Have a message made of the values of its fields."""
        made = f"{self.constant('U', unchecked_class(cls))}({', '.join(values)})"
        self.making += [f"{target} = {made}", f"{target}.__class__ = {self.constant('C', cls)}"]

    def make_all(self) -> None:
        """Write what makes the messages, inner ones first."""
        for text in self.making:
            self.line(text)

    def line(self, text: str) -> None:
        self.lines.append("    " * self.depth + text)

    def format_of(self, base: str) -> str:
        """The struct format of a number."""
        return "c" if base == "byte" and self.types.style == "rosidl" else FORMATS[base]

    def number(self, format_: str, expression: str) -> None:
        self.run.append(Item(format_, expression))

    def take_run(self, method: str) -> tuple[str, list[str], int | None] | None:
        """The struct for the run so far, its operands, and its size if that is fixed.

        The struct is an expression: where the size is fixed, of its bound `method`; else of the struct itself.
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
        table = tuple(layout_of(items, start, self.order) for start in range(widest))
        return f"{self.constant('S', table)}[p & {widest - 1}]", operands, None

    def compile(self, name: str, head: str, label: str) -> Any:
        source = "\n".join([head, *self.lines])
        exec(compile(source, f"<{label}>", "exec"), self.names)  # noqa: S102 - written above from a checked schema
        return self.names[name]


def padding(widest: int) -> tuple[bytes, ...]:
    """Zero bytes that align position p to `widest`, by `p & (widest - 1)`."""
    return tuple(bytes((HEADER - p) % widest) for p in range(widest))
