"""CDR, ROS 2's payload format: a pair of functions generated and compiled for each message type.

Runs of numbers become one `struct` call, numeric arrays one copy. The position of a field depends on the length of the
strings and arrays before it, so each run after the first of those has one `struct` per possible alignment, chosen
by the position; everything else is settled at compile time.

Positions count from the start of the payload, its 4-byte header included; alignment counts from after the header.

Source: OMG formal/02-06-51 chapter 15.3 (plain CDR, XCDR1), as ROS 2's serializers use it. Padding is written as zeros
and ignored when read; surplus bytes at the end are ignored.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

from graphflow.errors import DecodeError
from graphflow.wire.cdr.clone import Clone, compile_clone
from graphflow.wire.cdr.codegen import HEADER, Types
from graphflow.wire.cdr.decode import compile_decode
from graphflow.wire.cdr.encode import compile_encode, compile_encode_parts
from graphflow.wire.schema import Message

Encode = Callable[[Any], bytes]
EncodeParts = Callable[[Any], tuple[list[Any], int]]
Decode = Callable[[bytes], Any]


class Codec:
    """`encode(message) -> payload` and `decode(payload) -> message` for one type.

    Each is compiled at its first use, which takes about half a millisecond; types with numeric arrays then load numpy.
    Arrays of a decoded message are read-only views of the payload.

    `encode` raises EncodeError naming the field; `decode` raises DecodeError and nothing else.
    """

    def __init__(self, message: Message, types: Types) -> None:
        self._message, self._types = message, types

    @cached_property
    def encode(self) -> Encode:
        return compile_encode(self._message, self._types)

    @cached_property
    def encode_parts(self) -> EncodeParts:
        """`encode_parts(message) -> (parts, size)`: the payload as buffers; arrays are the message's own."""
        return compile_encode_parts(self._message, self._types)

    @cached_property
    def decode(self) -> Decode:
        return compile_decode(self._message, self._types, "<", self._decode_any_order)

    @cached_property
    def clone(self) -> Clone:
        """`clone(message)`: copies a message for a receiver in the same process."""
        return compile_clone(self._message, self._types, self.encode)

    @cached_property
    def _decode_big(self) -> Decode:
        return compile_decode(self._message, self._types, ">", None)

    def _decode_any_order(self, payload: bytes) -> Any:
        # The header of plain CDR: 00 00 for big-endian, 00 01 for little-endian, then two bytes of options.
        if len(payload) < HEADER or payload[0] != 0 or payload[1] > 1:
            head = payload[:4].hex() or "nothing"
            raise DecodeError(f"{self._message.name}: payload begins with {head}, not a CDR header")
        return self._decode_big(payload)
