"""A ring of slots in shared memory: one process writes large messages, and others of its user read them in place.

The memory is an anonymous file (`memfd_create`), which other processes open at `/proc/<pid>/fd/<fd>`: there is no name
that could be left behind, and the system frees it with the last process that uses it, however that process ends. Its
size is sealed, so that no reader can be made to read beyond its end.

    0       magic number, number of the ring, number of slots, bytes of a slot
    64      a generation for each slot: odd while it is written, another even number for each message
    1024    the readers, by number: the writer gives each a column
    1536    the number of slots that each reader may claim
    1600    a byte for each column, 1 once that reader has the ring open
    2048    a row for each slot: a byte for each column, 1 while that reader claims the slot
    4096    the slots

A reader claims a slot for as long as the message is in use, and the writer skips claimed slots. Each first writes its
own mark and then reads the other's, so that they cannot both own the slot. A reader without further claims copies. So
the writer never waits: slow, stopped or dead readers keep their share of the slots, and a message that is overwritten
before its descriptor was read is lost to that reader alone. A ring is used once all its readers have it open: its
messages then reach them even if the writer ends at once.

Source: Dekker's mutual exclusion for two; sequence locks as in Linux's `seqlock.h`; `memfd_create(2)`, `fcntl(2)`.
"""

from __future__ import annotations

import mmap
import os
import stat
import struct
from collections.abc import Collection, Sequence
from hashlib import blake2b
from threading import Lock
from typing import Any

from graphflow.system import is_portable
from graphflow.wire.shared_memory import Descriptor

SHARED_MEMORY_VARIABLE = "GRAPHFLOW_SHARED_MEMORY"
RING_BOUND = 96 << 20
"""Largest size of a ring's slots, in bytes."""
LEAST_SLOTS = 3
"""Fewest slots of a useful ring: one being written, and two being read."""
SPARE = 2
"""Slots that cannot be claimed: one being written, and one whose descriptor is in transit."""
MOST_SLOTS, MOST_READERS = 64, 32
MAPPED_BOUND = 64
"""Rings that a subscription has open, one or two per publisher."""
LEAD = 4096
"""Bytes of a slot before an array that is filled in place, for the message's fields before it."""

_HEAD = struct.Struct("<QQQQ")
_MAGIC = int.from_bytes(b"gflring1", "little")
_MARKS, _READERS, _SHARE, _OPENED, _CLAIMS, _SLOTS = 64, 1024, 1536, 1600, 2048, 4096
_UNCLAIMED = bytes(MOST_READERS)
_RING_NAME = "graphflow ring"
_PROOF_NAME = "graphflow session"

_lock = Lock()


def _fence() -> None:
    """Order all earlier writes before all later reads, on every processor."""
    with _lock:  # code before the second lock precedes its release, which precedes the next acquisition
        pass
    with _lock:
        pass


def can_share() -> bool:
    """Whether this process is able and permitted to share memory."""
    return not is_portable() and hasattr(os, "memfd_create") and os.environ.get(SHARED_MEMORY_VARIABLE, "1") != "0"


def open_proof(zid: str) -> int:
    """Open the file that proves to other processes of this user that a session is on this machine."""
    return os.memfd_create(f"{_PROOF_NAME} {zid}", os.MFD_CLOEXEC)


def is_proved(zid: str, pid: int, fd: int) -> bool:
    """Whether a session belongs to a process of this user on this machine."""
    path = f"/proc/{pid}/fd/{fd}"
    try:
        # Only processes of the same user, and root's, can read the link: so the owner is checked, too.
        is_named = os.readlink(path) == f"/memfd:{_PROOF_NAME} {zid} (deleted)"
        return is_named and os.stat(path).st_uid == os.geteuid()
    except OSError:
        return False


def number_of(zid: str, eid: int) -> int:
    """Return a subscription's number in a ring; never 0."""
    return int.from_bytes(blake2b(f"{zid}/{eid}".encode(), digest_size=8).digest(), "little") | 1


def slots_for(depths: Collection[int], size: int) -> int:
    """Return the number of slots of `size` bytes for readers with queues of these depths."""
    return min(sum(depths) + SPARE, MOST_SLOTS, RING_BOUND // _stride(size))


def _stride(size: int) -> int:
    return LEAD + -(-size // mmap.PAGESIZE) * mmap.PAGESIZE


class _Memory:
    """A ring's memory, with its tables."""

    __slots__ = ("claims", "map", "marks", "opened", "readers", "share", "slot_size", "slots", "view")

    def __init__(self, at: mmap.mmap, slots: int, slot_size: int) -> None:
        self.map, self.slots, self.slot_size = at, slots, slot_size
        self.view = view = memoryview(at)
        self.marks = view[_MARKS : _MARKS + 8 * slots].cast("Q")
        self.readers = view[_READERS : _READERS + 8 * MOST_READERS].cast("Q")
        self.share = view[_SHARE : _SHARE + 8].cast("Q")
        self.opened = view[_OPENED : _OPENED + MOST_READERS]
        self.claims = view[_CLAIMS : _CLAIMS + MOST_READERS * slots]

    def at(self, slot: int) -> int:
        """Return the position of a slot."""
        return _SLOTS + slot * self.slot_size


class Ring:
    """The writer's side of a ring. Not thread-safe.

    Args:
        slots: Number of slots, at most `slots_for`'s.
        size: Bytes of the longest message.

    Raises:
        OSError: Memory or file descriptors are exhausted.
    """

    def __init__(self, slots: int, size: int) -> None:
        import fcntl

        self._number = int.from_bytes(os.urandom(8), "little")
        self._fd = os.memfd_create(_RING_NAME, os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
        self.bytes = _SLOTS + slots * _stride(size)
        try:
            os.ftruncate(self._fd, self.bytes)
            fcntl.fcntl(self._fd, fcntl.F_ADD_SEALS, _seals())
            self._memory = _Memory(mmap.mmap(self._fd, self.bytes), slots, _stride(size))
        except BaseException:  # any error, interrupts included: the file is not left open
            os.close(self._fd)
            raise
        _HEAD.pack_into(self._memory.map, 0, _MAGIC, self._number, slots, _stride(size))
        self._pid = os.getpid()
        self._readers = 0
        self._next = 0
        self._lent: tuple[int, Any] | None = None

    def fits(self, depths: Collection[int], size: int) -> bool:
        """Whether messages of this size fit, and the slots are as many as `slots_for` allows these readers."""
        memory = self._memory
        return LEAD + size <= memory.slot_size and slots_for(depths, memory.slot_size - LEAD) <= memory.slots

    def admit(self, readers: Collection[int]) -> bool:
        """Give each reader a column, and take back those of readers that have left.

        Returns:
            False if a reader that has left still has claims. It may have ended, or only be unreachable; so this ring
            must be closed, and its memory stays with its readers while they use it.
        """
        memory = self._memory
        wanted, left = set(readers), []
        for column, number in enumerate(memory.readers):
            if number in wanted:
                wanted.discard(number)
            elif number:
                left.append(column)
                memory.readers[column] = 0
        _fence()
        if any(memory.claims[slot * MOST_READERS + column] for slot in range(memory.slots) for column in left):
            return False
        free = [column for column, number in enumerate(memory.readers) if not number]
        for column, number in zip(free, sorted(wanted), strict=False):
            memory.opened[column] = 0
            memory.readers[column] = number
        memory.share[0] = (memory.slots - SPARE) // max(1, len(readers))
        self._readers = len(readers)
        return True

    @property
    def is_open(self) -> bool:
        """Whether all its readers have it open."""
        memory = self._memory
        opened = sum(is_open for is_open, number in zip(memory.opened, memory.readers, strict=True) if number)
        return opened == self._readers

    @property
    def introduction(self) -> Descriptor:
        """Return a descriptor without a message, by which readers open the ring."""
        return Descriptor(self._pid, self._fd, self._number, 0, 0, 0, 0)

    def write(self, parts: Sequence[Any], size: int) -> Descriptor | None:
        """Write a message to a slot, or around its lent array; returns None if readers claim all slots.

        Args:
            parts: Consecutive buffers.
            size: Their total size in bytes.
        """
        placed = self._placed(parts) if self._lent is not None else None
        if placed is None:
            slot, start, skipped = self._begin(), LEAD, -1
            if slot is None:
                return None
        else:
            slot, start, skipped = placed
        at, view = self._memory.at(slot) + start, self._memory.view
        for index, part in enumerate(parts):
            data = memoryview(part).cast("B")
            if index != skipped:
                view[at : at + len(data)] = data
            at += len(data)
        return Descriptor(self._pid, self._fd, self._number, slot, start, size, self._end(slot))

    @property
    def is_lent(self) -> bool:
        """Whether one of its arrays is lent."""
        return self._lent is not None

    def lend(self, dtype: Any, count: int) -> Any:
        """Lend an array in a slot, to be filled and then written by `write`; one at a time. None if no slot is free."""
        import numpy

        slot = self._begin()
        if slot is None:
            return None
        array = numpy.frombuffer(self._memory.map, dtype, count, self._memory.at(slot) + LEAD)
        self._lent = slot, array
        return array

    def take_back(self) -> None:
        """End the loan: the slot may be written again, and the array becomes read-only."""
        if self._lent is not None:
            slot, array = self._lent
            array.flags.writeable = False
            if self._memory.marks[slot] % 2:  # the loan ended without a message
                self._end(slot)
            self._lent = None

    def close(self) -> None:
        """Close the writer's side; the system frees the memory with its last reader."""
        fd, self._fd = self._fd, -1
        if fd >= 0:
            os.close(fd)

    def _placed(self, parts: Sequence[Any]) -> tuple[int, int, int] | None:
        """Return slot and start of a message with the lent array, and the index of that part."""
        assert self._lent is not None
        slot, array = self._lent
        before = 0
        for index, part in enumerate(parts):
            if isinstance(part, memoryview) and part.obj is array:
                is_first = self._memory.marks[slot] % 2 == 1
                return (slot, LEAD - before, index) if is_first and before <= LEAD else None
            before += memoryview(part).nbytes
        return None

    def _begin(self) -> int | None:
        """Take the next slot that is neither claimed nor lent, and mark it as being written."""
        memory = self._memory
        marks, claims, slots = memory.marks, memory.claims, memory.slots
        for _ in range(slots):
            slot = self._next
            self._next = (slot + 1) % slots
            if marks[slot] % 2:  # the slot is lent
                continue
            # Mark, fence, look at the claims; `_Claims.take` does the reverse: at least one sees the other's mark.
            marks[slot] += 1
            _fence()
            if claims[slot * MOST_READERS : (slot + 1) * MOST_READERS] == _UNCLAIMED:
                return slot
            marks[slot] -= 1  # its message is unchanged
        return None

    def _end(self, slot: int) -> int:
        _fence()
        generation = self._memory.marks[slot] + 1
        self._memory.marks[slot] = generation
        return generation


class _Claims:
    """A ring, as one of its readers sees it."""

    __slots__ = ("_column", "_number", "count", "memory", "ring")

    def __init__(self, ring: int, memory: _Memory, number: int) -> None:
        self.ring, self.memory = ring, memory
        self._number = number
        self._column = -1
        self.count = 0
        """Slots claimed now."""

    def find_column(self) -> int:
        """Return the column that the writer has given this reader; -1 if none."""
        column, readers = self._column, self.memory.readers
        if column < 0 or readers[column] != self._number:
            numbers = readers.tolist()
            column = self._column = numbers.index(self._number) if self._number in numbers else -1
        return column

    def take(self, place: Descriptor) -> bytes | None:
        """Return the message in place, or a copy if no claim is left; None if it is overwritten."""
        memory, slot = self.memory, place.slot
        if slot >= memory.slots or place.start + place.size > memory.slot_size:
            return None
        at, column = memory.at(slot) + place.start, self.find_column()
        if column < 0 or self.count >= memory.share[0]:
            # Copied first, then checked: no claim protects it, so it may have been overwritten in between.
            copy = bytes(memory.view[at : at + place.size])
            _fence()
            return copy if memory.marks[slot] == place.generation else None
        index = slot * MOST_READERS + column
        memory.claims[index] = 1
        _fence()
        # The column may have been given to another reader, by an `admit` that did not see this claim.
        if memory.marks[slot] != place.generation or memory.readers[column] != self._number:
            memory.claims[index] = 0
            return None
        self.count += 1
        return claimed(memory.map, at, place.size, self, index)

    def release(self, index: int) -> None:
        self.count -= 1
        self.memory.claims[index] = 0


def claimed(at: mmap.mmap, position: int, size: int, claims: _Claims, index: int) -> bytes:
    """Return the message in a claimed slot, which is released with the last reference to the message or its arrays."""
    from graphflow.transport.shared_memory.ring_bytes import ring_bytes

    return ring_bytes(at, position, size, lambda: claims.release(index))


class RingReader:
    """The reader's side: the rings of a topic's publishers, as one subscription has them open. From any thread.

    Args:
        number: The subscription's number, from `number_of`.
    """

    def __init__(self, number: int) -> None:
        self._number = number
        self._open: dict[str, _Claims] = {}
        """The open rings, by the paths of their files."""

    def open(self, introduction: Descriptor) -> None:
        """Open a ring, and mark it as open for its writer."""
        claims = self._claims(introduction)
        if claims is not None and (column := claims.find_column()) >= 0:
            claims.memory.opened[column] = 1

    def take(self, descriptor: Descriptor) -> bytes | None:
        """Return a message, or None if it is overwritten; its arrays stay valid while in use."""
        claims = self._claims(descriptor)
        return None if claims is None else claims.take(descriptor)

    def _claims(self, descriptor: Descriptor) -> _Claims | None:
        path = f"/proc/{descriptor.pid}/fd/{descriptor.fd}"
        claims = self._open.get(path)
        if claims is None or claims.ring != descriptor.ring:
            memory = _map(path, descriptor.ring)
            if memory is None:
                return None
            self.forget_ended()
            while len(self._open) >= MAPPED_BOUND:
                self._open.pop(next(iter(self._open)), None)
            claims = self._open[path] = _Claims(descriptor.ring, memory, self._number)
        return claims

    def forget_ended(self) -> None:
        """Release the memory of rings whose writers have ended or have replaced them."""
        for path in list(self._open):
            if not _is_ring(path):
                self._open.pop(path, None)


def _is_ring(path: str) -> bool:
    try:
        return os.readlink(path) == f"/memfd:{_RING_NAME} (deleted)"
    except OSError:
        return False


def _map(path: str, ring: int) -> _Memory | None:
    """Open a ring.

    The descriptor may be forged by anyone on the network: it can only name files of this user, and of these only rings.
    """
    import fcntl

    if not _is_ring(path):
        return None
    try:
        fd = os.open(path, os.O_RDWR | os.O_CLOEXEC | os.O_NONBLOCK)  # by now it may be another file
    except OSError:
        return None
    try:
        found = os.fstat(fd)
        is_own = stat.S_ISREG(found.st_mode) and found.st_uid == os.geteuid() and found.st_size > _SLOTS
        # Without the seals, the file could shrink after this check, and a read beyond its end kills by SIGBUS.
        if not is_own or fcntl.fcntl(fd, fcntl.F_GET_SEALS) & _seals() != _seals():
            return None
        at = mmap.mmap(fd, found.st_size)
    except OSError:
        return None
    finally:
        os.close(fd)
    magic, number, slots, slot_size = _HEAD.unpack_from(at)
    fits = 0 < slots <= MOST_SLOTS and slots * slot_size + _SLOTS <= found.st_size
    return _Memory(at, slots, slot_size) if magic == _MAGIC and number == ring and fits else None


def _seals() -> int:
    import fcntl

    return fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW | fcntl.F_SEAL_SEAL
