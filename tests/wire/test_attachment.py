"""The 33 bytes beside every message."""

from __future__ import annotations

import pytest

from graphflow.errors import DecodeError
from graphflow.wire import attachment

GID = bytes.fromhex("eb85fa883b7846dc448a4501890ad062")
RECORDED = bytes.fromhex("010000000000000015cd853dfe9c971710eb85fa883b7846dc448a4501890ad062")


def test_packs_the_recorded_bytes() -> None:
    """Sequence number, time and GID become the bytes that rmw_zenoh's own serialiser writes."""
    assert attachment.pack(1, 1_700_000_000_123_456_789, GID) == RECORDED


def test_reads_the_recorded_bytes() -> None:
    """The recorded bytes give back what was packed."""
    assert attachment.unpack(RECORDED) == attachment.MessageInfo(1, 1_700_000_000_123_456_789, GID)


@pytest.mark.parametrize("sequence", [0, 1, 2**63 - 1, -1])
def test_carries_every_sequence_number(sequence: int) -> None:
    """Packing and unpacking give the same values, whatever the sequence number."""
    assert attachment.unpack(attachment.pack(sequence, -5, bytes(range(16)))) == (sequence, -5, bytes(range(16)))


def test_size_is_that_of_the_protocol() -> None:
    """An attachment has 33 bytes."""
    assert attachment.SIZE == len(RECORDED) == 33


@pytest.mark.parametrize("data", [b"", RECORDED[:-1], RECORDED + b"\0", bytes(77)])
def test_refuses_another_length(data: bytes) -> None:
    """Bytes of any other length, the 77 of old peers too, are a DecodeError that tells both lengths."""
    with pytest.raises(DecodeError, match=f"of {len(data)} bytes.*33"):
        attachment.unpack(data)


def test_refuses_a_gid_of_another_length() -> None:
    """A length byte other than 16 is a DecodeError that tells it."""
    with pytest.raises(DecodeError, match="GID of 15 bytes"):
        attachment.unpack(RECORDED[:16] + b"\x0f" + RECORDED[17:])
