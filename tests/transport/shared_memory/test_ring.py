"""Slots in shared memory."""

from __future__ import annotations

import fcntl
import gc
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from graphflow.system import is_portable
from graphflow.transport.shared_memory import ring
from graphflow.transport.shared_memory.ring import SPARE, Ring, RingReader, number_of, slots_for
from graphflow.wire.shared_memory import Descriptor, unpack
from tests.cases import slow
from tests.conftest import LIMIT

pytestmark = pytest.mark.skipif(is_portable() or not hasattr(os, "memfd_create"), reason="memory cannot be shared here")

SIZE = 100_000
ALICE, BOB = number_of("a", 1), number_of("b", 1)


def pattern(number: int, size: int = SIZE) -> bytes:
    return bytes([number % 256]) * size


def write(writer: Ring, number: int) -> Descriptor:
    place = writer.write([b"head", pattern(number)], SIZE + 4)
    assert place is not None
    return place


def taken(place: Descriptor | None, reader: RingReader | None = None) -> bytes:
    assert place is not None
    message = (reader or RingReader(ALICE)).take(place)
    assert message is not None
    return message


@pytest.fixture
def writer() -> Iterator[Ring]:
    """A ring of six slots, of which Alice may claim four."""
    made = Ring(6, SIZE + 4)
    made.admit([ALICE])
    yield made
    made.close()


def test_a_message_is_read_where_it_lies(writer: Ring) -> None:
    """All of it, as something that decodes like bytes, cannot be written, and is no copy."""
    reader = RingReader(ALICE)
    found: Any = reader.take(write(writer, 7))
    assert bytes(found) == b"head" + pattern(7)
    assert (found[:4], found[4:6], found[0], len(found)) == (b"head", b"\7\7", ord("h"), SIZE + 4)
    array = np.frombuffer(found, np.uint8, 10, 4)
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 1
    assert not array.flags.owndata


@slow
def test_a_claimed_slot_is_passed_over(writer: Ring) -> None:
    """However often the writer comes round, also when only an array of the message is left."""
    reader = RingReader(ALICE)
    kept = np.frombuffer(taken(write(writer, 1), reader), np.uint8, SIZE, 4)
    slots = {write(writer, n).slot for n in range(2, 30)}
    assert len(slots) == 5
    assert set(kept.tolist()) == {1}
    del kept
    gc.collect()
    assert len({write(writer, n).slot for n in range(30, 60)}) == 6


def test_what_is_overwritten_is_lost(writer: Ring) -> None:
    """A descriptor that is read too late leads to nothing, and to no part of another message."""
    reader = RingReader(ALICE)
    late = [write(writer, n) for n in range(13)]
    found = [reader.take(place) for place in late]
    assert [None if f is None else f[4] for f in found] == [None] * 7 + [7, 8, 9, 10, 11, 12]


def test_beyond_its_share_a_reader_copies(writer: Ring) -> None:
    """So that the writer always has slots: these messages are bytes, and outlive the slot."""
    reader = RingReader(ALICE)
    kept = [reader.take(write(writer, n)) for n in range(20)]
    assert [isinstance(k, bytes) for k in kept] == [False] * 4 + [True] * 16
    assert [bytes(k)[4] for k in kept if k is not None] == list(range(20))


def test_readers_share_the_slots(writer: Ring) -> None:
    """Each has its part, and one that is unknown only copies."""
    writer.admit([ALICE, BOB])
    readers = {name: RingReader(number) for name, number in (("alice", ALICE), ("bob", BOB), ("eve", 77))}
    kept: dict[str, list[Any]] = {name: [] for name in readers}
    for n in range(4):
        place = write(writer, n)
        for name, reader in readers.items():
            kept[name].append(reader.take(place))
    claimed = {name: sum(not isinstance(k, bytes) for k in found) for name, found in kept.items()}
    assert claimed == {"alice": 2, "bob": 2, "eve": 0}


@slow
def test_a_reader_leaves(writer: Ring) -> None:
    """Its column is free again; but not while it claims something, since it may use that yet."""
    writer.admit([ALICE, BOB])
    alice, place = RingReader(ALICE), write(writer, 1)
    kept = [alice.take(place), RingReader(BOB).take(place)]
    assert not writer.admit([BOB])
    kept.clear()
    gc.collect()
    assert writer.admit([BOB])
    assert isinstance(alice.take(write(writer, 2)), bytes)
    assert writer.admit([])


@slow
def test_a_reader_is_put_out_while_it_claims(writer: Ring, monkeypatch: pytest.MonkeyPatch) -> None:
    """The writer has looked at the claims already, and may write the slot: the message is lost to this reader."""
    alice, place, fence = RingReader(ALICE), write(writer, 1), ring._fence

    def meanwhile() -> None:
        monkeypatch.setattr(ring, "_fence", fence)
        writer.admit([])

    assert alice.take(place) is not None
    gc.collect()
    monkeypatch.setattr(ring, "_fence", meanwhile)
    # The claim is written by now, so the writer sees it too: neither believes that the slot is its own.
    assert alice.take(place) is None
    assert writer.admit([])


def test_all_slots_claimed(writer: Ring) -> None:
    """Then the writer says so, and the messages stay as they are."""
    writer.admit(range(1, 2))
    writer._memory.share[0] = 6
    reader = RingReader(1)
    kept = [reader.take(write(writer, n)) for n in range(6)]
    assert writer.write([b"x"], 1) is None
    assert [bytes(k)[4] for k in kept if k is not None] == list(range(6))


@pytest.mark.parametrize(
    ("depths", "size", "slots"),
    [
        ([10], 1 << 20, 12),
        ([1], 1 << 20, 3),
        ([10] * 20, 1 << 20, 64),
        ([10], 20 << 20, 4),
        ([10], 40 << 20, 2),
        ([], 1, 2),
    ],
)
def test_slots_for(depths: list[int], size: int, slots: int) -> None:
    """As many as wait in the queues and two, in `RING_BOUND` bytes."""
    assert slots_for(depths, size) == slots
    assert slots <= sum(depths) + SPARE
    assert slots * size <= ring.RING_BOUND


def test_it_is_open_when_all_readers_say_so(writer: Ring) -> None:
    """Those that come later have to say so, too; those that leave do not count."""
    writer.admit([ALICE, BOB])
    alice, bob = RingReader(ALICE), RingReader(BOB)
    alice.open(writer.introduction)
    assert not writer.is_open
    bob.open(writer.introduction)
    assert writer.is_open
    RingReader(77).open(writer.introduction)
    assert writer.is_open
    writer.admit([ALICE])
    assert writer.is_open
    writer.admit([ALICE, 78])
    assert not writer.is_open


class TestLoans:
    def test_an_array_is_filled_in_place(self, writer: Ring) -> None:
        """What comes before and behind it is written around it; the array cannot be written afterwards."""
        array = writer.lend(np.dtype(np.uint16), 1000)
        array[:] = 258
        place = writer.write([b"before!", array.data, b"end"], 2010)
        writer.take_back()
        assert place is not None
        assert bytes(taken(place)) == b"before!" + b"\2\1" * 1000 + b"end"
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1

    def test_other_messages_go_elsewhere(self, writer: Ring) -> None:
        """The slot is nobody else's during the loan, and it is free afterwards, written or not."""
        array = writer.lend(np.dtype(np.uint8), 10)
        array[:] = 5
        assert len({write(writer, n).slot for n in range(20)}) == 5
        assert set(array.tolist()) == {5}
        writer.take_back()
        assert len({write(writer, n).slot for n in range(20)}) == 6

    def test_it_is_published_once(self, writer: Ring) -> None:
        """A second message with the same array is a copy: the first may be read by now."""
        array = writer.lend(np.dtype(np.uint8), 10)
        places = [writer.write([b"a", array.data], 11) for _ in range(2)]
        assert len({p.slot for p in places if p is not None}) == 2

    def test_a_long_beginning(self, writer: Ring) -> None:
        """What does not fit before the array is written elsewhere with it."""
        array = writer.lend(np.dtype(np.uint8), 10)
        array[:] = 9
        place = writer.write([b"x" * 5000, array.data], 5010)
        assert place is not None
        assert bytes(taken(place)) == b"x" * 5000 + b"\t" * 10


class TestForged:
    """Anybody on the network can send descriptors."""

    def test_places_outside(self, writer: Ring) -> None:
        """Slots that are not there, and messages that end after theirs."""
        good = write(writer, 1)
        for place in (
            good._replace(slot=6),
            good._replace(slot=2**32 - 1),
            good._replace(start=SIZE),
            good._replace(size=2**32 - 1),
            good._replace(generation=good.generation + 2),
            good._replace(ring=good.ring ^ 1),
            good._replace(pid=2**32 - 1),
            good._replace(fd=0),
        ):
            assert RingReader(ALICE).take(place) is None

    def test_files_that_are_no_rings(self, writer: Ring) -> None:
        """They are not opened by another name, and by the right one only with their size sealed and a ring inside."""
        good = write(writer, 1)
        read, sent = os.pipe()
        named = os.memfd_create("graphflow ring", os.MFD_ALLOW_SEALING)
        os.ftruncate(named, 1 << 20)
        os.pwrite(named, os.pread(good.fd, 4096, 0), 0)  # a ring in all but its seals
        sealed = os.memfd_create("graphflow ring", os.MFD_ALLOW_SEALING)
        os.pwrite(sealed, os.pread(good.fd, 4096, 0), 0)
        fcntl.fcntl(sealed, fcntl.F_ADD_SEALS, fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW | fcntl.F_SEAL_SEAL)
        try:
            for fd in (read, named, sealed):
                assert RingReader(ALICE).take(good._replace(fd=fd)) is None
        finally:
            for fd in (read, sent, named, sealed):
                os.close(fd)

    def test_proofs(self) -> None:
        """A session is a neighbour's only by a file with its own id."""
        fd = ring.open_proof("abc")
        try:
            assert ring.is_proved("abc", os.getpid(), fd)
            assert not ring.is_proved("abd", os.getpid(), fd)
            assert not ring.is_proved("abc", os.getpid(), fd + 1000)
            assert not ring.is_proved("abc", 2**31, fd)
        finally:
            os.close(fd)

    def test_another_user(self, monkeypatch: pytest.MonkeyPatch, writer: Ring) -> None:
        """Neither its proofs nor its rings count, not even for root, who could open them."""
        place, fd = write(writer, 1), ring.open_proof("abc")
        monkeypatch.setattr(os, "geteuid", lambda: 12345)
        assert not ring.is_proved("abc", os.getpid(), fd)
        assert RingReader(ALICE).take(place) is None
        os.close(fd)

    def test_open_rings_are_bounded(self) -> None:
        """So many publishers as a subscription may have rings of, and no more."""
        reader, rings = RingReader(ALICE), []
        for _ in range(ring.MAPPED_BOUND + 3):
            rings.append(Ring(3, 100))
            assert taken(rings[-1].write([b"x"], 1), reader)[0] == ord("x")
        assert len(reader._open) == ring.MAPPED_BOUND
        for made in rings:
            made.close()


WRITER = """
import sys
from graphflow.transport.shared_memory.ring import Ring
ring = Ring(4, 100_000)
ring.admit([int(sys.argv[1])])
for number in range(int(sys.argv[2])):
    place = ring.write([bytes([number % 256]) * 100_000], 100_000)
    sys.stdout.write(place.pack().hex() + "\\n")
    sys.stdout.flush()
sys.stdin.read()
"""


def start_writer(number: int, messages: int) -> subprocess.Popen[str]:
    words = [sys.executable, "-c", WRITER, str(number), str(messages)]
    return subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def place_of(line: str) -> Descriptor:
    place = unpack(bytes.fromhex(line))
    assert place is not None
    return place


@pytest.mark.real
class TestProcesses:
    def test_nothing_is_torn(self) -> None:
        """A reader that the writer laps all the time gets whole messages or none, claimed and copied."""
        reader, process = RingReader(ALICE), start_writer(ALICE, 3000)
        assert process.stdout is not None
        kept: list[Any] = []
        try:
            for _ in range(3000):
                message = reader.take(place_of(process.stdout.readline()))
                if message is not None:
                    kept = [*kept[-9:], message]
                    assert all(len(set(bytes(m))) == 1 for m in kept[-4:])
        finally:
            process.kill()
            process.communicate(timeout=LIMIT)
        assert kept

    def test_a_killed_writer_leaves_nothing(self) -> None:
        """What its readers hold stays good for them; then the memory is the system's again."""
        process = start_writer(ALICE, 1)
        assert process.stdout is not None
        place = place_of(process.stdout.readline())
        reader = RingReader(ALICE)
        kept: Any = reader.take(place)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=LIMIT)
        assert set(bytes(kept)) == {0}
        assert reader.take(place) is not None  # it is still open
        reader.forget_ended()
        assert reader.take(place) is None
        assert set(bytes(kept)) == {0}


def test_the_proof_of_a_session(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is a file of this user that has the session's name."""
    fd, other = ring.open_proof("abc"), os.memfd_create("other")
    try:
        assert ring.is_proved("abc", os.getpid(), fd)
        assert not ring.is_proved("abd", os.getpid(), fd)
        assert not ring.is_proved("abc", os.getpid(), other)
        monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
        assert not ring.is_proved("abc", os.getpid(), fd)
    finally:
        os.close(fd)
        os.close(other)


def test_the_size_of_a_ring_is_sealed(writer: Ring) -> None:
    """Nobody can be made to read beyond its end."""
    for size in (0, writer.bytes + 1):
        with pytest.raises(PermissionError):
            os.ftruncate(writer._fd, size)


def test_what_is_no_ring(writer: Ring, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of another user, another file, or of a size that may change."""
    path, number = f"/proc/{os.getpid()}/fd/{writer._fd}", writer._number
    assert ring._map(path, number) is not None
    assert ring._map(path, number + 1) is None
    content = os.pread(writer._fd, writer.bytes, 0)
    for name, seals in ((ring._RING_NAME, 0), ("other", ring._seals())):
        fd = os.memfd_create(name, os.MFD_ALLOW_SEALING)
        os.write(fd, content)
        fcntl.fcntl(fd, fcntl.F_ADD_SEALS, seals)
        assert ring._map(f"/proc/{os.getpid()}/fd/{fd}", number) is None
        os.close(fd)
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert ring._map(path, number) is None
