"""The 33 bytes that go with every publication, request and response: sequence number, time, sender.

Layout: int64 sequence number, int64 source time in ns since 1970, the byte 16, then the 16 bytes of the GID;
little-endian. Jazzy before 0.2.4 wrote 77 bytes with names, which are not read here.

Source: rmw_zenoh attachment_helpers.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from graphflow.errors import DecodeError

LAYOUT = struct.Struct("<qqB16s")
SIZE = LAYOUT.size
_pack, _unpack = LAYOUT.pack, LAYOUT.unpack
_new = tuple.__new__
"""Creates a named tuple without its Python-level constructor: one is created for every message."""


class MessageInfo(NamedTuple):
    """The metadata of a message."""

    sequence: int
    """Sequence number, from 1 per publisher or client."""
    source_ns: int
    """Time of sending, nanoseconds since 1970 on the sender's clock."""
    gid: bytes
    """The GID, 16 bytes: the sender's or, in a response, the client's."""


def pack(sequence: int, source_ns: int, gid: bytes) -> bytes:
    """Encode an attachment.

    Args:
        gid: 16 bytes.
    """
    return _pack(sequence, source_ns, 16, gid)


def fields(data: bytes) -> tuple[int, int, bytes]:
    """Read the fields of `MessageInfo` from an attachment.

    Raises:
        DecodeError: `data` has another length or layout.
    """
    try:
        sequence, source_ns, size, gid = _unpack(data)
    except struct.error:
        raise DecodeError(f"attachment of {len(data)} bytes; rmw_zenoh's has {SIZE}") from None
    if size != 16:
        raise DecodeError(f"attachment with a GID of {size} bytes; rmw_zenoh's has 16")
    return sequence, source_ns, gid


def unpack(data: bytes) -> MessageInfo:
    """Read an attachment.

    Raises:
        DecodeError: `data` has another length or layout.
    """
    return _new(MessageInfo, fields(data))
