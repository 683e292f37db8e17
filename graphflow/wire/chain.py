"""Call chains: the runs of handlers that await a call, directly or through each other, nearest last.

A chain follows the attachment of a request between graphflow processes. Layout: the letter `c`, the number of hops,
then for each hop the first 8 bytes of its process's Zenoh id, the number of the run there (uint64), and the call that
it awaits: GID (16 bytes) and sequence number (int64); little-endian.

A server whose group is full of runs in the chain knows that the call can never be answered.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

_HEAD = b"c"
_HOP = struct.Struct("<8sQ16sq")
LONGEST = 16
"""Largest number of hops in a chain; a call with a longer chain carries none."""


class Hop(NamedTuple):
    """One run that awaits a call."""

    process: bytes
    """The first 8 bytes of the process's Zenoh id."""
    run: int
    gid: bytes
    """The GID of the calling client."""
    sequence: int


def process_of(zid: str) -> bytes:
    """Return a process's name in a chain, from its Zenoh id in hex."""
    # Zenoh writes ids without leading zeros.
    return bytes.fromhex(zid.rjust(16, "0")[:16])


def extended(chain: bytes, hop: Hop) -> bytes:
    """Append a hop to a chain; empty if it becomes too long or is not a chain."""
    count = len(hops(chain))
    if (chain and not count) or count >= LONGEST:
        return b""
    return b"%c%c%b%b" % (_HEAD, count + 1, chain[2:], _HOP.pack(*hop))


def hops(chain: bytes) -> list[Hop]:
    """Return the hops of a chain; none if the bytes are not a chain."""
    if len(chain) < 2 or chain[:1] != _HEAD or chain[1] > LONGEST or len(chain) != 2 + chain[1] * _HOP.size:
        return []
    return [Hop(*hop) for hop in _HOP.iter_unpack(chain[2:])]
