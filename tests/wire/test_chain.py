"""The chain of runs that wait for a call, as it stands behind a request's attachment."""

from __future__ import annotations

import pytest

from graphflow.wire.chain import LONGEST, Hop, extended, hops, process_of

FIRST = Hop(bytes(range(8)), 1, bytes(16), 7)
SECOND = Hop(b"\xff" * 8, 2**64 - 1, bytes(range(16)), -1)


def chain_of(*members: Hop) -> bytes:
    chain = b""
    for hop in members:
        chain = extended(chain, hop)
    return chain


def test_hops_come_back_in_their_order() -> None:
    """The nearest run is the last, and every number of its kind fits."""
    assert hops(chain_of(FIRST, SECOND)) == [FIRST, SECOND]
    assert hops(b"") == []


def test_the_layout() -> None:
    """A letter, a count, then 40 bytes a hop, little-endian."""
    chain = chain_of(Hop(b"abcdefgh", 2, b"G" * 16, 3))

    assert chain == b"c\x01" + b"abcdefgh" + b"\2\0\0\0\0\0\0\0" + b"G" * 16 + b"\3\0\0\0\0\0\0\0"


def test_a_chain_has_a_longest() -> None:
    """A call behind sixteen others carries none, instead of one that misses somebody."""
    full = chain_of(*[FIRST] * LONGEST)

    assert len(hops(full)) == LONGEST
    assert extended(full, SECOND) == b""


@pytest.mark.parametrize(
    "wrong",
    [
        b"c",
        b"x\x01" + chain_of(FIRST)[2:],
        chain_of(FIRST)[:-1],
        chain_of(FIRST) + b"\0",
        b"c\x02" + chain_of(FIRST)[2:],
        bytes([99, LONGEST + 1]) + bytes(40) * (LONGEST + 1),
    ],
)
def test_bytes_that_are_no_chain(wrong: bytes) -> None:
    """Bytes of another program have no hops, and no hop is appended."""
    assert hops(wrong) == []
    assert extended(wrong, FIRST) == b""


@pytest.mark.parametrize(
    ("zid", "process"),
    [
        ("aac3178e146ba6f1fc6e6a4085e77f21", "aac3178e146ba6f1"),
        ("1", "0000000000000001"),
        ("ac3178e146ba6f1", "0ac3178e146ba6f1"),
    ],
)
def test_a_process_is_known_by_eight_bytes(zid: str, process: str) -> None:
    """The first of its Zenoh id, which Zenoh prints without leading zeros."""
    assert process_of(zid) == bytes.fromhex(process)
