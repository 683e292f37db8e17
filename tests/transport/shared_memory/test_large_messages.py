"""A publication whose large messages go through a ring, without a network."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pytest

from graphflow.system import is_portable
from graphflow.transport.base import Payload
from graphflow.transport.shared_memory import large_messages, ring
from graphflow.transport.shared_memory.large_messages import LARGE_FROM, RingSender
from graphflow.transport.shared_memory.ring import RingReader, number_of
from graphflow.wire.shared_memory import Descriptor, unpack

pytestmark = pytest.mark.skipif(is_portable() or not hasattr(os, "memfd_create"), reason="memory cannot be shared here")

ALICE, BOB = ("a", 1), ("b", 2)


class Wire:
    """What was sent, and a reader that takes in what is described."""

    is_wanted = True

    def __init__(self, *readers: tuple[str, int]) -> None:
        self.sent: list[bytes] = []
        self.places: list[Descriptor] = []
        self.introduced = 0
        self.readers = [RingReader(number_of(*who)) for who in readers]
        self.sender = RingSender(self, self.describe)

    def put(self, payload: Payload, *, attachment: bytes) -> None:
        self.sent.append(bytes(payload))

    def describe(self, descriptor: bytes, attachment: bytes) -> None:
        place = unpack(descriptor)
        assert place is not None
        if place.size:
            self.places.append(place)
            return
        self.introduced += 1
        for reader in self.readers:
            reader.open(place)

    def publish(self, size: int = LARGE_FROM) -> None:
        self.sender.put_parts(([b"x" * size], size), attachment=b"")

    def close(self) -> None:
        """Nothing is open."""

    @property
    def counts(self) -> tuple[int, int, int]:
        return len(self.sent), len(self.places), self.introduced


def test_without_readers_all_is_sent() -> None:
    """Also while nobody has told who they are."""
    wire = Wire()
    wire.publish()
    wire.sender.admit(None)
    wire.publish()
    wire.sender.admit({})
    wire.publish()
    assert wire.counts == (3, 0, 0)
    assert wire.sender.memory == 0


def test_large_ones_go_through_memory() -> None:
    """Once the readers have it open; small ones never do."""
    wire = Wire(ALICE)
    wire.sender.admit({ALICE: 10})
    wire.publish(LARGE_FROM - 1)
    assert wire.counts == (1, 0, 0)
    for _ in range(3):
        wire.publish()
    assert wire.counts == (1, 3, 1)
    assert wire.sender.in_memory == 3
    assert 12 * LARGE_FROM < wire.sender.memory < 14 * (LARGE_FROM + 3 * 4096) + 12 * LARGE_FROM // 8


def test_a_reader_that_does_not_open_it() -> None:
    """Messages are sent until it does; it is asked once."""
    wire = Wire(ALICE)
    wire.sender.admit({ALICE: 10, BOB: 10})
    for _ in range(3):
        wire.publish()
    assert wire.counts == (3, 0, 1)
    wire.sender.admit({ALICE: 10})
    wire.publish()
    assert wire.counts == (3, 1, 2)


def test_a_larger_message_makes_a_larger_ring() -> None:
    """The readers open that one, too; what is too large for any is sent."""
    wire = Wire(ALICE)
    wire.sender.admit({ALICE: 10})
    wire.publish()
    before = wire.sender.memory
    wire.publish(3 * LARGE_FROM)
    assert wire.sender.memory > 2 * before
    wire.publish(ring.RING_BOUND // 2)
    assert wire.counts == (1, 2, 2)


def test_the_ring_of_a_reader_that_left() -> None:
    """If it still claims something, its memory is no longer written, and there is another ring."""
    wire = Wire(ALICE, BOB)
    wire.sender.admit({ALICE: 10, BOB: 10})
    wire.publish()
    kept: Any = wire.readers[1].take(wire.places[0])
    wire.sender.admit({ALICE: 10})
    for _ in range(40):
        wire.publish()
    assert len({place.ring for place in wire.places}) == 2
    assert set(bytes(kept)) == {ord("x")}


def test_no_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then messages are sent."""

    def refused(*_: object) -> None:
        raise OSError(12, "Cannot allocate memory")

    monkeypatch.setattr(large_messages, "Ring", refused)
    wire = Wire(ALICE)
    wire.sender.admit({ALICE: 10})
    wire.publish()
    assert wire.counts == (1, 0, 0)


def test_too_many_readers() -> None:
    """More than a ring has columns for."""
    readers = {("r", n): 1 for n in range(ring.MOST_READERS + 1)}
    wire = Wire(*readers)
    wire.sender.admit(readers)
    wire.publish()
    assert wire.counts == (1, 0, 0)


def test_loans() -> None:
    """One at a time, only of what is large, and only in a ring that is open; the ring is not replaced meanwhile."""
    wire = Wire(ALICE)
    dtype = np.dtype(np.uint8)
    assert wire.sender.lend(dtype, 10 * LARGE_FROM) is None
    wire.sender.admit({ALICE: 10})
    assert wire.sender.lend(dtype, LARGE_FROM - 1) is None
    array = wire.sender.lend(dtype, LARGE_FROM)
    assert array.size == LARGE_FROM
    assert wire.sender.lend(dtype, LARGE_FROM) is None
    wire.publish(20 * LARGE_FROM)
    assert wire.counts == (1, 0, 1)
    wire.sender.put_parts(([b"head", array.data], LARGE_FROM + 4), attachment=b"")
    wire.sender.take_back()
    assert wire.counts == (1, 1, 1)
    wire.publish(20 * LARGE_FROM)
    assert wire.counts == (1, 2, 2)


def test_it_ends_with_its_publisher() -> None:
    """And sends nothing through memory afterwards."""
    wire = Wire(ALICE)
    wire.sender.admit({ALICE: 10})
    wire.publish()
    wire.sender.close()
    wire.sender.close()
    assert wire.sender.memory == 0
    assert wire.readers[0].take(wire.places[0]) is not None
    wire.readers[0].forget_ended()
    assert wire.readers[0].take(wire.places[0]) is None
