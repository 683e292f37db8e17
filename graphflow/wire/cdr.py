"""CDR, ROS 2's payload format: a pair of functions written and compiled for each message type.

Runs of numbers become one `struct` call, numeric arrays one copy. Where a field lies depends on the length of the
strings and arrays before it, so each run after the first of those has one `struct` per possible alignment, chosen
by the position; everything else is settled when the function is made.

Positions count from the start of the payload, its 4-byte header included; alignment counts from after the header.

Source: OMG formal/02-06-51 chapter 15.3 (plain CDR, XCDR1), as ROS 2's serialisers use it. Padding is written as zeros
and ignored when read, surplus bytes at the end are ignored.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from graphflow.errors import DecodeError
from graphflow.wire.codegen import HEADER, Types
from graphflow.wire.decode import compile_decode
from graphflow.wire.encode import compile_encode
from graphflow.wire.schema import Message

Encode = Callable[[Any], bytes]
Decode = Callable[[bytes], Any]


class Codec(NamedTuple):
    """`encode(message) -> payload` and `decode(payload) -> message` for one type.

    Arrays of a decoded message are read-only views of the payload.

    `encode` raises EncodeError naming the field; `decode` raises DecodeError and nothing else.
    """

    encode: Encode
    decode: Decode


def compile_codec(message: Message, types: Types) -> Codec:
    """Write and compile the codec of one message type. Takes about a millisecond; the result is to be kept."""
    decode_big = None

    def decode_any_order(payload: bytes) -> Any:
        nonlocal decode_big
        if len(payload) < HEADER or payload[0] != 0 or payload[1] > 1:
            raise DecodeError(f"{message.name}: payload begins with {payload[:4].hex() or 'nothing'}, not a CDR header")
        if decode_big is None:
            decode_big = compile_decode(message, types, ">", None)
        return decode_big(payload)

    return Codec(compile_encode(message, types), compile_decode(message, types, "<", decode_any_order))
