"""Descriptors and the tokens of readers."""

from __future__ import annotations

import pytest

from graphflow.wire.shared_memory import (
    Descriptor,
    Reader,
    parse_reader,
    reader_token,
    readers_key,
    ring_key,
    unpack,
)


def test_descriptors_come_back() -> None:
    """A descriptor has one length; anything else is none."""
    place = Descriptor(1, 2, 2**64 - 1, 4, 5, 6, 2**63)
    assert unpack(place.pack()) == place
    for payload in (b"", place.pack()[:-1], place.pack() + b"x"):
        assert unpack(payload) is None


def test_tokens_come_back() -> None:
    """On keys of graphflow's own, which name the domain."""
    reader = Reader("abc", 3, 1234, 9)
    assert reader_token(7, reader) == "@graphflow/7/reader/abc/3/1234/9"
    assert parse_reader(reader_token(7, reader)) == reader
    assert readers_key(7) == "@graphflow/7/reader/**"
    assert ring_key(7, "7/a/b/c") == "@graphflow/7/ring/7/a/b/c"


@pytest.mark.parametrize(
    "token",
    [
        "",
        "@graphflow/7/proc/abc/3/1234/9",
        "@graphflow/7/reader/abc/3/1234",
        "@graphflow/7/reader/abc/3/1234/9/10",
        "@graphflow/7/reader/abc/x/1234/9",
        "@graphflow/7/reader/abc/3/-1/9",
        "@graphflow/7/reader/abc/3/1234/" + "9" * 100,
        "@graphflow/7/reader/" + "a" * 10_000 + "/3/1234/9",
        "@graphflow/7/reader/a\x1bc/3/1234/9",
    ],
)
def test_other_tokens_are_none(token: str) -> None:
    """Whatever somebody else announces there."""
    assert parse_reader(token) is None
