"""The compiler of the decoder of a message type."""

from __future__ import annotations

import struct
import sys
from array import array
from collections.abc import Callable
from functools import partial
from typing import Any

from graphflow.errors import DecodeError
from graphflow.wire.cdr.codegen import FORMATS, Code, Order, Parts, Types, min_size, value_count
from graphflow.wire.schema import Field, FieldType, Message

Decode = Callable[[bytes], Any]


class Decoder(Code):
    def __init__(self, types: Types, order: Order, parts: Parts) -> None:
        super().__init__(types, order, parts)
        self.names["new"] = object.__new__

    def flush(self) -> None:
        run = self.take_run("unpack_from")
        if run is None:
            return
        layout, targets, size = run
        start = "p" if self.position is None else str(self.position - (size or 0))
        unpack = f"({', '.join(targets)},) = " if targets else ""
        if size is None:
            self.line(f"s = {layout}")
            self.line(f"{unpack}s.unpack_from(buf, p)")
            self.line("p += s.size")
        else:
            self.line(f"{unpack}{layout}(buf, {start})")
            if self.position is None:
                self.line(f"p += {size}")

    def go_dynamic(self) -> None:
        self.flush()
        if self.position is not None:
            self.line(f"p = {self.position}")
            self.position = None

    def message(self, message: Message, target: str) -> None:
        cls = self.types.message_class(message.name)
        if self.types.style == "rosidl":
            local = self.fresh("o")
            self.line(f"{local} = {target} = new({self.constant('C', cls)})")
            values = [f"{local}._{field.name}" for field in message.fields]
        else:
            values = [self.fresh("v") for _ in message.fields]
        if not message.fields:
            self.number("x", "")
        for field, value in zip(message.fields, values, strict=True):
            self.field(field, value)
        if self.types.style != "rosidl":
            self.make(cls, values, target)

    def field(self, field: Field, target: str) -> None:
        type_ = field.type
        if not type_.array:
            self.single(type_, target)
        elif type_.base in FORMATS:
            self.numeric_array(type_, target)
        else:
            self.object_array(type_, target)

    def single(self, type_: FieldType, target: str) -> None:
        if type_.base in FORMATS:
            self.number(self.format_of(type_.base), target)
        elif type_.base in ("string", "wstring"):
            self.string(type_, target)
        else:
            self.message(self.types.schema(type_.base), target)

    def string(self, type_: FieldType, target: str) -> None:
        n = self.fresh("n")
        self.number("I", n)
        self.go_dynamic()
        wide = type_.base == "wstring"
        self.line(f"e = p + {n}{' * 4' if wide else ''}")
        # Slicing past the end raises nothing: it would silently return a shorter string.
        self.line("if e > size: raise ValueError('a string ends after the payload')")
        if wide:
            self.names["narrow"] = _narrow
            self.line(f"{target} = narrow(buf[p:e], {self.order!r})")
        else:
            # The length includes the final NUL. A length of 0 is an empty string, too, as for ROS 2's own readers.
            self.line(f"{target} = buf[p:e - 1].decode() if {n} else ''")
        self.line("p = e")

    def numeric_array(self, type_: FieldType, target: str) -> None:
        size = struct.calcsize(FORMATS[type_.base])
        n = str(type_.size)
        if type_.array != "fixed":
            n = self.fresh("n")
            self.number("I", n)
        self.go_dynamic()
        if size > 1:
            align = f"p += (4 - p) & {size - 1}"
            # Fast CDR writes no padding before the elements of an empty sequence; a fixed array is never empty.
            self.line(align if type_.array == "fixed" else f"if {n}: {align}")
        self.line(f"e = p + {n} * {size}")
        self.line("if e > size: raise ValueError('an array ends after the payload')")
        match self.types.style:
            case "list":
                self.unpacked(type_, target, n)
            case "rosidl" if type_.base in ("bool", "byte"):
                self.unpacked(type_, target, n)
            case "rosidl" if type_.array != "fixed":
                self.names["read_array"] = _read_array
                self.line(f"{target} = read_array({FORMATS[type_.base]!r}, buf[p:e], {self.order == '>'})")
            case style:
                copy = ".copy()" if style == "rosidl" else ""
                self.line(f"{target} = array_view(buf, {self._dtype(type_)}, {n}, p){copy}")
        self.line("p = e")

    def unpacked(self, type_: FieldType, target: str, count: str) -> None:
        """Unpack numbers one by one: each takes many times its encoded size in memory."""
        self.limited(count)
        self.names["unpack_from"] = struct.unpack_from
        self.line(f"{target} = list(unpack_from(f'{self.order}{{{count}}}{self.format_of(type_.base)}', buf, p))")

    def _dtype(self, type_: FieldType) -> str:
        from graphflow.wire.cdr import arrays

        self.names["array_view"] = arrays.view
        return self.constant("D", arrays.DTYPES[type_.base].newbyteorder("<" if self.order == "<" else ">"))

    def limited(self, count: str) -> None:
        self.line(f"left[0] -= {count}")
        self.line(f"if left[0] < 0: raise ValueError('its lists have more than {self.types.values:,} values')")

    def object_array(self, type_: FieldType, target: str) -> None:
        n, items = str(type_.size), self.fresh("l")
        if type_.array != "fixed":
            n = self.fresh("n")
            self.number("I", n)
        self.go_dynamic()
        element = type_._replace(array="")
        # Refused before it is built: a count of 2**32 in a few bytes must not exhaust the memory.
        least = min_size(element, self.types.schema)
        self.line(f"if {n} * {least} > size - p: raise ValueError('a sequence claims more than the payload holds')")
        self.limited(f"{n} * {value_count(element, self.types.schema)}")
        self.line(f"{items} = []")
        self.line(f"for _ in range({n}):")
        self.depth += 1
        item = self.fresh("i")
        if type_.is_primitive:
            self.single(element, item)
        else:
            decode = self.part(type_.base, partial(compile_decode_part, self.order))
            self.line(f"{item}, p = {decode}(buf, p, size, left)")
        self.line(f"{items}.append({item})")
        self.depth -= 1
        self.line(f"{target} = {items}")


def _read_array(code: str, payload: bytes, is_foreign: bool) -> array[Any]:
    """Read numbers as `array.array`; swap their bytes if their order is not this machine's."""
    numbers = array(code, payload)
    if is_foreign is (sys.byteorder == "little"):
        numbers.byteswap()
    return numbers


def _narrow(utf32: bytes, order: Order) -> str:
    """Convert UTF-16 code units, each sent as a uint32, to text."""
    count = len(utf32) // 4
    units = struct.unpack(f"{order}{count}I", utf32)
    if max(units, default=0) > 0xFFFF:
        raise ValueError("a wstring has a code unit above 0xffff")
    return struct.pack(f"<{count}H", *units).decode("utf-16-le", "surrogatepass")


def compile_decode_part(order: Order, message: Message, types: Types, parts: Parts) -> Any:
    """Compile `decode(buf, p, size, left) -> (message, p)`: read at position p; `left` bounds the number of values."""
    code = Decoder(types, order, parts)
    code.position = None
    code.message(message, "o")
    code.flush()
    code.make_all()
    code.line("return o, p")
    return code.compile("decode", "def decode(buf, p, size, left):", message.name)


def compile_decode(message: Message, types: Types, order: Order, otherwise: Decode | None) -> Decode:
    code = Decoder(types, order, {})
    code.names["otherwise"], code.names["failed"] = otherwise, _failed
    code.names["name"] = message.name
    if otherwise is not None:
        code.line("if buf[:2] != b'\\0\\1': return otherwise(buf)")
    code.line("try:")
    code.depth += 1
    before = len(code.lines)
    code.message(message, "o")
    code.flush()
    code.make_all()
    if code.position is None:
        code.lines.insert(before, f"        size, left = len(buf), [{types.values}]")
    code.line("return o")
    code.depth -= 1
    # A UnicodeDecodeError is a ValueError, too.
    code.names["Errors"] = (struct.error, ValueError, OverflowError)
    code.line("except Errors as error:")
    code.line("    failed(name, buf, error)")
    result: Decode = code.compile("decode", "def decode(buf):", message.name)
    return result


def _failed(name: str, buf: bytes, error: Exception) -> None:
    if isinstance(error, struct.error):
        raise DecodeError(f"{name}: the payload of {len(buf)} bytes ends early") from None
    raise DecodeError(f"{name}: {error} ({len(buf)} bytes)") from None
