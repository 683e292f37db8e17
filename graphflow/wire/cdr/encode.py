"""The compiler of the encoder of a message type."""

from __future__ import annotations

import struct
from array import array
from collections.abc import Callable, Iterable
from typing import Any, cast

from graphflow.errors import EncodeError
from graphflow.wire.cdr.codegen import FORMATS, LITTLE, Code, Parts, Types, padding
from graphflow.wire.schema import Field, FieldType, Message


class Encoder(Code):
    def __init__(self, types: Types, parts: Parts) -> None:
        super().__init__(types, "<", parts)

    def flush(self) -> None:
        run = self.take_run("pack")
        if run is None:
            return
        layout, operands, size = run
        if size is None:
            self.line(f"s = {layout}")
            self.line(f"parts.append(s.pack({', '.join(operands)}))")
            self.line("p += s.size")
        else:
            self.line(f"parts.append({layout}({', '.join(operands)}))")
            if self.position is None:
                self.line(f"p += {size}")

    def go_dynamic(self) -> None:
        """Switch to a position that only the variable `p` knows."""
        self.flush()
        if self.position is not None:
            self.line(f"p = {self.position}")
            self.position = None

    def message(self, message: Message, expression: str) -> None:
        if not message.fields:
            # ROS 2 gives a type without fields one hidden byte (`typehash.HIDDEN`).
            self.number("x", "")
        for field in message.fields:
            self.field(field, f"{expression}.{self.types.prefix}{field.name}")

    def field(self, field: Field, expression: str) -> None:
        type_ = field.type
        if not type_.array:
            self.single(type_, expression)
        elif type_.base in FORMATS:
            self.numeric_array(type_, expression)
        else:
            self.object_array(type_, expression)

    def single(self, type_: FieldType, expression: str) -> None:
        if type_.base in FORMATS:
            if type_.base == "bool":
                # struct packs any object by its truth value: a lookup by key accepts only True and False.
                self.names["BOOL"] = {True: True, False: False}
                expression = f"BOOL[{expression}]"
            self.number(self.format_of(type_.base), expression)
        elif type_.base == "string":
            self.string(type_, expression)
        elif type_.base == "wstring":
            self.wide_string(type_, expression)
        else:
            nested = self.types.schema(type_.base)
            if len(nested.fields) > 1:
                local = self.fresh("m")
                self.line(f"{local} = {expression}")
                expression = local
            self.message(nested, expression)

    def string(self, type_: FieldType, expression: str) -> None:
        text = self.fresh("t")
        self.line(f"{text} = {expression}.encode() + b'\\0'")
        if type_.string_bound:
            # The bound does not count the final NUL.
            self.line(f"if len({text}) > {type_.string_bound + 1}: raise ValueError('too long')")
        self.number("I", f"len({text})")
        self.go_dynamic()
        self.line(f"parts.append({text})")
        self.line(f"p += len({text})")

    def wide_string(self, type_: FieldType, expression: str) -> None:
        text = self.fresh("t")
        self.line(f"{text} = {expression}.encode('utf-16-le', 'surrogatepass')")
        if type_.string_bound:
            self.line(f"if len({text}) > {2 * type_.string_bound}: raise ValueError('too long')")
        # A wstring is counted in UTF-16 code units, each sent as a uint32, without a terminator, unlike a string.
        self.number("I", f"len({text}) // 2")
        self.go_dynamic()
        self.names["widen"] = _widen
        self.line(f"parts.append(widen({text}))")
        self.line(f"p += 2 * len({text})")

    def numeric_array(self, type_: FieldType, expression: str) -> None:
        if self.types.style == "rosidl" and (type_.base in ("bool", "byte") or type_.array != "fixed"):
            self.rosidl_array(type_, expression)
            return
        from graphflow.wire.cdr import arrays

        dtype = self.constant("D", arrays.DTYPES[type_.base])
        self.names["ndarray"], self.names["as_array"] = arrays.ndarray, arrays.as_array
        size = struct.calcsize(FORMATS[type_.base])
        a = self.fresh("a")
        self.line(f"{a} = {expression}")
        self.line(f"if {a}.__class__ is not ndarray or {a}.dtype != {dtype} or not {a}.flags.c_contiguous:")
        self.line(f"    {a} = as_array({a}, {type_.base!r})")
        check_count(self, type_, f"{a}.size")
        if type_.array != "fixed":
            self.number("I", f"{a}.size")
        self.go_dynamic()
        if type_.array == "fixed":
            self.align(size)
            self.line(f"parts.append({a}.data)")
            self.line(f"p += {a}.nbytes")
            return
        # Fast CDR writes no padding before the elements of an empty sequence.
        self.line(f"if {a}.size:")
        self.depth += 1
        self.align(size)
        self.line(f"parts.append({a}.data)")
        self.line(f"p += {a}.nbytes")
        self.depth -= 1

    def rosidl_array(self, type_: FieldType, expression: str) -> None:
        """Encode rosidl's representation of arrays: lists of bools or bytes, and `array.array`."""
        a, format_ = self.fresh("a"), FORMATS[type_.base]
        self.line(f"{a} = {expression}")
        check_count(self, type_, f"len({a})")
        if type_.base == "bool":
            self.names["flags"] = _flags
            self.line(f"{a} = flags({a})")
        elif type_.base == "byte":
            self.line(f"{a} = b''.join({a})")
        else:
            self.names["array"] = array
            self.line(f"if {a}.__class__ is not array or {a}.typecode != {format_!r}: {a} = array({format_!r}, {a})")
        if type_.array != "fixed":
            self.number("I", f"len({a})")
        self.go_dynamic()
        self.line(f"if {a}:")
        self.depth += 1
        size = struct.calcsize(format_)
        self.align(size)
        self.line(f"parts.append({a})")
        self.line(f"p += len({a}){f' * {size}' if size > 1 else ''}")
        self.depth -= 1

    def align(self, size: int) -> None:
        if size > 1:
            pads = self.constant("P", padding(size))
            self.line(f"s = {pads}[p & {size - 1}]")
            self.line("parts.append(s)")
            self.line("p += len(s)")

    def object_array(self, type_: FieldType, expression: str) -> None:
        items, item = self.fresh("l"), self.fresh("i")
        self.line(f"{items} = {expression}")
        if type_.is_primitive:
            # A str or mapping would iterate as strings: their characters or keys.
            self.line(f"if isinstance({items}, (str, dict)): raise TypeError('not a sequence')")
        check_count(self, type_, f"len({items})")
        if type_.array != "fixed":
            self.number("I", f"len({items})")
        self.go_dynamic()
        self.line(f"for {item} in {items}:")
        self.depth += 1
        if type_.is_primitive:
            self.single(type_._replace(array=""), item)
        else:
            self.line(f"p = {self.part(type_.base, compile_encode_part)}({item}, parts, p)")
        self.depth -= 1


def check_count(code: Code, type_: FieldType, count: str) -> None:
    """Write the check of an array's number of elements."""
    if type_.array == "fixed":
        code.line(f"if {count} != {type_.size}: raise ValueError('wrong length')")
    elif type_.array == "bounded":
        code.line(f"if {count} > {type_.size}: raise ValueError('too long')")


def _flags(values: Iterable[object]) -> bytes:
    """Encode truth values as bytes."""
    return bytes(1 if value is True else 0 if value is False else _refuse(value) for value in values)


def _refuse(value: object) -> int:
    raise ValueError(f"{value!r} is neither true nor false")


def _widen(utf16: bytes) -> bytes:
    """Widen UTF-16 code units to a uint32 each."""
    count = len(utf16) // 2
    return struct.pack(f"<{count}I", *struct.unpack(f"<{count}H", utf16))


def compile_encode_part(message: Message, types: Types, parts: Parts) -> Any:
    """Compile `encode(message, parts, p) -> p`: append to a payload that is at position p."""
    code = Encoder(types, parts)
    code.position = None
    code.message(message, "m")
    code.flush()
    code.line("return p")
    return code.compile("encode", "def encode(m, parts, p):", message.name)


def compile_encode(message: Message, types: Types) -> Callable[[Any], bytes]:
    return cast("Callable[[Any], bytes]", _compile(message, types, "b''.join(parts)"))


def compile_encode_parts(message: Message, types: Types) -> Callable[[Any], tuple[list[Any], int]]:
    """Compile the encoder that returns the payload in parts, for a type with an array."""
    return cast("Callable[[Any], tuple[list[Any], int]]", _compile(message, types, "parts, p"))


def _compile(message: Message, types: Types, result: str) -> Callable[..., Any]:
    code = Encoder(types, {})
    code.position = 0
    code.number("I", str(LITTLE))
    code.line("try:")
    code.depth += 1
    code.line("parts = []")
    code.message(message, "m")
    if code.position == 0:
        # Everything is in one run: the type has a fixed size.
        layout, operands, _ = code.take_run("pack") or ("", [], 0)
        code.lines.remove("        parts = []")
        code.line(f"return {layout}({', '.join(operands)})")
    else:
        code.flush()
        code.line(f"return {result}")
    code.depth -= 1
    # Any wrong value fails above, in its own way; the slow path converts or names the field.
    code.names["EncodeError"] = EncodeError
    code.line("except EncodeError: raise")
    code.line("except Exception: pass")
    code.line("return again(m, is_copy)")

    def again(m: Any, is_copy: bool) -> Any:
        if is_copy:
            raise EncodeError(f"{message.name}: cannot encode {m!r}")
        return encode(types.checked(m), True)

    code.names["again"] = again
    encode: Callable[..., Any] = code.compile("encode", "def encode(m, is_copy=False):", message.name)
    return encode
