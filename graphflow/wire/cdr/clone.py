"""The compiler of clone functions, which copy a message without a detour through CDR.

The copy is what a receiver would have decoded: numbers are checked and rounded by the same `struct` formats, nested
messages are new objects, and arrays are read-only (`wire.cdr.lending` decides which are shared). So a node sees no
difference when its peer is in the same process.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

from graphflow.errors import EncodeError
from graphflow.wire.cdr.codegen import FORMATS, Code, Item, Parts, Types
from graphflow.wire.cdr.encode import check_count
from graphflow.wire.schema import FieldType, Message

Clone = Callable[[Any], Any]


class Cloner(Code):
    """Each number of the run is its source expression; `targets` has the destinations."""

    def __init__(self, types: Types, parts: Parts) -> None:
        super().__init__(types, "<", parts)
        self.targets: list[str] = []

    def flush(self) -> None:
        """Write the copy of the numbers so far from one message to the other."""
        if not self.run:
            return
        items, self.run = self.run, []
        targets, self.targets = self.targets, []
        layout = struct.Struct("<" + "".join(item.format for item in items))
        pack, unpack = self.constant("S", layout.pack), self.constant("U", layout.unpack)
        self.line(f"({', '.join(targets)},) = {unpack}({pack}({', '.join(item.expression for item in items)}))")

    def message(self, message: Message, source: str, copy: str) -> None:
        values = [self.fresh("v") for _ in message.fields]
        for field, value in zip(message.fields, values, strict=True):
            self.field(field.type, f"{source}.{field.name}", value, field.name)
        self.make(self.types.message_class(message.name), values, copy)

    def field(self, type_: FieldType, source: str, target: str, name: str) -> None:
        if type_.array and type_.base in FORMATS:
            self.numeric_array(type_, source.rpartition(".")[0], name, target)
        elif type_.array:
            self.object_array(type_, source, target)
        else:
            self.single(type_, source, target)

    def single(self, type_: FieldType, source: str, target: str) -> None:
        if type_.base in FORMATS:
            if type_.base == "bool":
                # As the encoder does: only True and False pass, not any object with a truth value.
                self.names["BOOL"] = {True: True, False: False}
                source = f"BOOL[{source}]"
            self.run.append(Item(FORMATS[type_.base], source))
            self.targets.append(target)
        elif type_.base in ("string", "wstring"):
            self.names["text"], self.names["wide_text"] = _text, _wide_text
            function = "text" if type_.base == "string" else "wide_text"
            self.line(f"{target} = {function}({source}, {type_.string_bound})")
        else:
            local = self.fresh("m")
            self.line(f"{local} = {source}")
            self.message(self.types.schema(type_.base), local, target)

    def numeric_array(self, type_: FieldType, owner: str, name: str, target: str) -> None:
        from graphflow.wire.cdr import lending

        self.names["lend"] = lending.lend
        a = self.fresh("a")
        self.line(f"{target} = {a} = lend({owner}, {name!r}, {type_.base!r})")
        check_count(self, type_, f"{a}.size")

    def object_array(self, type_: FieldType, source: str, target: str) -> None:
        items = self.fresh("l")
        self.line(f"{items} = {source}")
        if type_.is_primitive:
            # A str or mapping would iterate as strings: their characters or keys.
            self.line(f"if isinstance({items}, (str, dict)): raise TypeError('not a sequence')")
            self.names["text"], self.names["wide_text"] = _text, _wide_text
            function = "text" if type_.base == "string" else "wide_text"
            made = f"{function}(i, {type_.string_bound})"
        else:
            made = f"{self.part(type_.base, compile_clone_part)}(i)"
        check_count(self, type_, f"len({items})")
        self.line(f"{target} = [{made} for i in {items}]")


def _text(text: str, bound: int) -> str:
    """Return a string as it would arrive; raises the error of encoding it."""
    # ASCII decodes to itself. Other strings take the detour: a lone surrogate has to fail as it would in the encoder.
    if text.__class__ is str and not bound and text.isascii():
        return text
    encoded = text.encode()
    if bound and len(encoded) > bound:
        raise ValueError("too long")
    return encoded.decode()


def _wide_text(text: str, bound: int) -> str:
    units = text.encode("utf-16-le", "surrogatepass")
    if bound and len(units) > 2 * bound:
        raise ValueError("too long")
    return units.decode("utf-16-le", "surrogatepass")


def compile_clone_part(message: Message, types: Types, parts: Parts) -> Clone:
    """Compile `clone(message)` for a nested message: wrong values raise any exception."""
    code = Cloner(types, parts)
    code.message(message, "m", "o")
    code.flush()
    code.make_all()
    code.line("return o")
    clone: Clone = code.compile("clone", "def clone(m):", f"{message.name} cloned")
    return clone


def compile_clone(message: Message, types: Types, encode: Callable[[Any], bytes]) -> Clone:
    """Compile `clone(message)`, which raises the same EncodeError as encoding."""
    part = compile_clone_part(message, types, {})

    def clone(m: Any) -> Any:
        try:
            return part(m)
        except EncodeError:
            raise
        except Exception:  # any error: the slow path converts, or names the field
            encode(m)
            return part(types.checked(m))

    return clone
