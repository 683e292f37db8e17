"""The messages by which processes of one user on one machine share memory.

@graphflow/<domain>/reader/<zid>/<eid>/<pid>/<fd>    the token of a subscription that reads rings, and its proof
@graphflow/<domain>/ring/<data key>                  descriptors, in place of a topic's large messages

A reader proves that it is a process of the same user on the same machine by an open file: an anonymous file with the
session's id in its name, which only such a process can have at `/proc/<pid>/fd/<fd>`.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from graphflow.wire.liveliness import TOKEN_BOUND, whole_number

_DESCRIPTOR = struct.Struct("<IIQIIIQ")
DESCRIPTOR_SIZE = _DESCRIPTOR.size


class Descriptor(NamedTuple):
    """The place of a message in shared memory."""

    pid: int
    """The writing process."""
    fd: int
    """The descriptor of the ring's file in that process."""
    ring: int
    """A random number at the beginning of the ring."""
    slot: int
    start: int
    """Offset in bytes from the beginning of the slot."""
    size: int
    generation: int
    """The generation of the slot while it holds the message."""

    def pack(self) -> bytes:
        return _DESCRIPTOR.pack(*self)


def unpack(payload: bytes) -> Descriptor | None:
    """Parse a descriptor; None if it is not one."""
    return Descriptor._make(_DESCRIPTOR.unpack(payload)) if len(payload) == DESCRIPTOR_SIZE else None


class Reader(NamedTuple):
    """A subscription that reads rings."""

    zid: str
    eid: int
    pid: int
    fd: int


def reader_token(domain: int, reader: Reader) -> str:
    return f"@graphflow/{domain}/reader/{reader.zid}/{reader.eid}/{reader.pid}/{reader.fd}"


def readers_key(domain: int) -> str:
    """Return the key that matches the tokens of all readers."""
    return f"@graphflow/{domain}/reader/**"


def parse_reader(token: str) -> Reader | None:
    """Parse a token; None if the text is not one."""
    parts = token.split("/") if len(token) <= TOKEN_BOUND and token.isprintable() else []
    if len(parts) != 7 or parts[0] != "@graphflow" or parts[2] != "reader":
        return None
    eid, pid, fd = (whole_number(part) for part in parts[4:])
    return None if eid is None or pid is None or fd is None else Reader(parts[3], eid, pid, fd)


def ring_key(domain: int, data_key: str) -> str:
    """Return the key for the descriptors of a topic's large messages."""
    return f"@graphflow/{domain}/ring/{data_key}"
