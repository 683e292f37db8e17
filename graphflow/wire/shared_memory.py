"""How processes of one user on one machine tell each other of memory that they share.

@graphflow/<domain>/reader/<zid>/<eid>/<pid>/<fd>    the token of a subscription that reads rings, and its proof
@graphflow/<domain>/ring/<data key>                  descriptors, in the place of a topic's large messages

A reader proves that it is a process of the same user on the same machine by an open file: an anonymous one with its
session's id in its name, which only such a process can have at `/proc/<pid>/fd/<fd>`.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from graphflow.wire.liveliness import TOKEN_BOUND, whole_number

_DESCRIPTOR = struct.Struct("<IIQIIIQ")
DESCRIPTOR_SIZE = _DESCRIPTOR.size


class Descriptor(NamedTuple):
    """Where a message lies."""

    pid: int
    """The writing process."""
    fd: int
    """The ring's file there."""
    ring: int
    """A random number that the ring begins with."""
    slot: int
    start: int
    """Bytes from the slot's beginning."""
    size: int
    generation: int
    """The slot's while it holds the message."""

    def pack(self) -> bytes:
        return _DESCRIPTOR.pack(*self)


def unpack(payload: bytes) -> Descriptor | None:
    """Read a descriptor; None if it is none."""
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
    """The key that the tokens of all readers match."""
    return f"@graphflow/{domain}/reader/**"


def parse_reader(token: str) -> Reader | None:
    """Read a token; None if the text is none."""
    parts = token.split("/") if len(token) <= TOKEN_BOUND and token.isprintable() else []
    if len(parts) != 7 or parts[0] != "@graphflow" or parts[2] != "reader":
        return None
    eid, pid, fd = (whole_number(part) for part in parts[4:])
    return None if eid is None or pid is None or fd is None else Reader(parts[3], eid, pid, fd)


def ring_key(domain: int, data_key: str) -> str:
    """Where the descriptors of a topic's large messages are published."""
    return f"@graphflow/{domain}/ring/{data_key}"
