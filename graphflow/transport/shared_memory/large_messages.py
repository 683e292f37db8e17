"""Large messages over Zenoh between processes of one user on one machine: only their memory location is sent.

A descriptor is sent on a key of its own, unknown to ROS 2, and only while every known receiver reads it; otherwise an
ordinary message is sent, which every receiver understands. Receivers get both directly on Zenoh's thread, and so in the
order of sending.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import Any

import zenoh

from graphflow.transport.base import Closable, Sender
from graphflow.transport.event_loop.foreign_threads import at_once
from graphflow.transport.inbox import Inbox
from graphflow.transport.shared_memory.ring import (
    LEAST_SLOTS,
    MOST_READERS,
    Ring,
    RingReader,
    can_share,
    number_of,
    slots_for,
)
from graphflow.wire.shared_memory import unpack

__all__ = ["LARGE_FROM", "RingReceiver", "RingSender", "can_share", "receive"]

LARGE_FROM = 64 << 10
"""Smallest message in bytes to send through memory; for smaller ones a copy costs less than the ring."""
DEEPEST = 10
"""Longest queue in memory, the default depth; readers with longer queues copy arrivals."""


class RingSender:
    """A publisher whose large messages go through a ring: `base.LargeSender`.

    Args:
        sender: Sends small messages, and all messages to receivers that do not read rings.
        describe: Sends a descriptor and an attachment to receivers that do.
    """

    def __init__(self, sender: Sender, describe: Callable[[bytes, bytes], None]) -> None:
        self._put, self._describe = sender.put, describe
        self._readers: dict[int, int] | None = None
        """The readers' queue depths by number, while all receivers are readers; else None."""
        self._ring: Ring | None = None
        self._is_introduced = self._is_open = False
        self.in_memory = 0

    @property
    def memory(self) -> int:
        return 0 if self._ring is None else self._ring.bytes

    def admit(self, readers: Mapping[tuple[str, int], int] | None) -> None:
        if readers is None:
            self._readers = None
            return
        self._readers = {number_of(*who): depth for who, depth in readers.items()}
        # A reader that has just come must open the ring before it is sent a descriptor.
        self._is_introduced = self._is_open = False
        ring = self._ring
        if ring is not None and not ring.admit(self._readers):
            ring.close()
            self._ring = None

    def put_parts(self, parts: tuple[list[Any], int], *, attachment: bytes) -> None:
        buffers, size = parts
        ring = self._ring_for(size) if size >= LARGE_FROM else None
        place = None if ring is None else ring.write(buffers, size)
        if place is None:
            self._put(b"".join(buffers), attachment=attachment)
        else:
            self._describe(place.pack(), attachment)
            self.in_memory += 1

    def _ring_for(self, size: int) -> Ring | None:
        """Return a ring for a message of this size that all readers have open; None if it must be sent."""
        readers, ring = self._readers, self._ring
        if not readers:
            return None
        depths = [min(depth, DEEPEST) for depth in readers.values()]
        if ring is None or not ring.fits(depths, size):
            if ring is not None and ring.is_lent:  # the array being filled is in this ring
                return None
            ring = self._new_ring(depths, size + size // 8)  # the size of point clouds varies
        if ring is None or self._is_open:
            return ring
        if not self._is_introduced:
            self._describe(ring.introduction.pack(), b"")
            self._is_introduced = True
        self._is_open = ring.is_open
        return ring if self._is_open else None

    def _new_ring(self, depths: Collection[int], size: int) -> Ring | None:
        slots = slots_for(depths, size)
        if slots < LEAST_SLOTS or len(depths) > MOST_READERS:
            return None
        if self._ring is not None:
            self._ring.close()
        self._is_introduced = self._is_open = False
        try:
            self._ring = Ring(slots, size)
        except OSError:  # no memory, or no more files
            self._ring = None
        else:
            self._ring.admit(self._readers or ())
        return self._ring

    def lend(self, dtype: Any, count: int) -> Any:
        size = int(count) * int(dtype.itemsize)
        ring = self._ring_for(size) if size >= LARGE_FROM else None
        return None if ring is None or ring.is_lent else ring.lend(dtype, count)

    def take_back(self) -> None:
        if self._ring is not None:
            self._ring.take_back()

    def close(self) -> None:
        ring, self._ring, self._readers = self._ring, None, None
        if ring is not None:
            ring.close()


class _InRing:
    """A message in its sender's memory, with the interface of Zenoh's samples."""

    __slots__ = ("_payload", "attachment")

    def __init__(self, payload: bytes, attachment: Any) -> None:
        self._payload, self.attachment = payload, attachment

    @property
    def payload(self) -> _InRing:
        return self

    def __len__(self) -> int:
        return len(self._payload)

    def to_bytes(self) -> bytes:
        return self._payload


class RingReceiver:
    """A receiver of descriptors: `base.RingReceiver`."""

    def __init__(self, proof: tuple[int, int], reader: RingReader, declared: Closable) -> None:
        self.reader = proof
        self._rings, self._declared = reader, declared

    def forget_ended(self) -> None:
        self._rings.forget_ended()

    def close(self) -> None:
        self._declared.close()


def receive(reader: RingReader, inbox: Inbox) -> Any:
    """Return a handler of descriptors that claims or copies the messages, and counts those already overwritten."""

    def arrived(sample: zenoh.Sample) -> None:
        descriptor = unpack(sample.payload.to_bytes())
        if descriptor is None:
            return
        if not descriptor.size:
            reader.open(descriptor)
            return
        payload = reader.take(descriptor)
        if payload is None:
            inbox.dropped += 1
        else:
            inbox.put(_InRing(payload, sample.attachment))

    return at_once(arrived)
