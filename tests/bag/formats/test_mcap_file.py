"""MCAP files in all their forms, cut off, damaged, and hostile."""

from __future__ import annotations

import struct
import tracemalloc
from pathlib import Path
from typing import Any

import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import CompressionType, IndexType, Writer

from graphflow.bag.formats import mcap_file
from graphflow.bag.formats.mcap_file import McapFile
from graphflow.bag.reader import Bag
from graphflow.errors import BagError
from tests.cases import cases, count, slow


def plain_mcap(path: Path, times: list[int], **options: Any) -> Path:
    with path.open("wb") as stream:
        writer: Any = Writer(stream, **options)
        writer.start("ros2", "test")
        schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data\n")
        channel = writer.register_channel("/chatter", "cdr", schema)
        for number, when in enumerate(times):
            writer.add_message(channel, when, str(number).encode(), when)
        writer.finish()
    return path


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"chunk_size": 60},
        {"chunk_size": 60, "compression": CompressionType.LZ4},
        {"use_chunking": False},
        {"index_types": IndexType.NONE},
        {"use_statistics": False},
        {"repeat_channels": False},
        {"use_summary_offsets": False},
    ],
)
def test_other_forms_of_mcap(tmp_path: Path, options: dict[str, Any]) -> None:
    """With and without chunks, index and statistics; out of order in the file, in order when they are read."""
    times = [5, 3, 9, 1, 7, 2, 8, 2]
    bag = Bag(plain_mcap(tmp_path / "a.mcap", times, **options))
    assert [(r.log_ns, r.data) for r in bag.records()] == [
        (1, b"3"), (2, b"5"), (2, b"7"), (3, b"1"), (5, b"0"), (7, b"4"), (8, b"6"), (9, b"2"),
    ]  # fmt: skip
    assert (bag.contents.start_ns, bag.contents.end_ns, bag.contents.message_count) == (1, 9, 8)
    assert bag.contents.is_whole


def test_a_bag_that_ends_anywhere(tmp_path: Path) -> None:
    """Whatever is whole of it is read, and the rest is no error."""
    whole = plain_mcap(tmp_path / "a.mcap", list(range(100, 130)), chunk_size=60).read_bytes()
    cut, most = tmp_path / "cut.mcap", 0
    for end in range(8, len(whole), 37):
        cut.write_bytes(whole[:end])
        bag = Bag(cut)
        found = list(bag.records())
        assert [r.log_ns for r in found] == list(range(100, 100 + len(found)))
        assert len(found) >= most
        assert not bag.contents.is_whole
        most = len(found)
    assert most == 30


@slow
@cases(count(few=60, full=1500))
@given(st.data())
def test_a_bag_with_bytes_that_are_wrong(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    """It is read as far as it goes, or refused in words; nothing else happens."""
    folder = tmp_path_factory.getbasetemp()
    good = folder / "good.mcap"
    if not good.exists():
        plain_mcap(good, list(range(100, 130)), chunk_size=200)
    damaged = bytearray(good.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        damaged[data.draw(st.integers(8, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    bad = folder / "bad.mcap"
    bad.write_bytes(damaged)
    error = None
    try:
        assert len(list(Bag(bad).records())) <= 40
    except BagError as refused:
        error = str(refused)
    assert error is None or str(bad) in error


def test_a_chunk_that_claims_to_be_huge(tmp_path: Path) -> None:
    """Nothing is unpacked that is larger than it says, or than any is."""
    packed = zstandard.compress(bytes(50_000_000))
    for claimed in (100, 1 << 40):
        body = struct.pack("<QQQI", 1, 1, claimed, 0) + struct.pack("<I", 4) + b"zstd"
        body += struct.pack("<Q", len(packed)) + packed
        file = tmp_path / f"{claimed}.mcap"
        file.write_bytes(b"\x89MCAP0\r\n" + struct.pack("<BQ", 6, len(body)) + body)
        assert McapFile(file).contents.message_count == 0


def test_a_summary_that_leads_into_a_chunk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is no summary: what it names would be unpacked, however large."""
    path = plain_mcap(tmp_path / "a.mcap", list(range(100, 130)), chunk_size=200)
    data = bytearray(path.read_bytes())
    chunk = data.index(struct.pack("<B", 6), 8)
    data[-28:-20] = struct.pack("<Q", chunk)
    path.write_bytes(data)
    monkeypatch.setattr("mcap.stream_reader.get_chunk_data_stream", lambda *_, **__: pytest.fail("it was unpacked"))
    assert len(list(Bag(path).records())) == 30


def test_a_byte_that_is_wrong_in_a_message(tmp_path: Path) -> None:
    """Is no message."""
    path = plain_mcap(tmp_path / "a.mcap", [1, 2], compression=CompressionType.NONE)
    data = bytearray(path.read_bytes())
    place = data.index(struct.pack("<HIQQ", 1, 0, 2, 2)) + 22
    assert data[place : place + 1] == b"1"
    data[place] ^= 1
    path.write_bytes(data)
    with pytest.raises(BagError, match=r"a\.mcap: the chunk at byte \d+ is damaged \(its checksum does not match\)"):
        list(McapFile(path).records())


def test_what_a_chunk_may_cost(tmp_path: Path) -> None:
    """No more than it says, however much is in it."""
    packed = zstandard.compress(bytes(100_000_000))
    body = struct.pack("<QQQI", 1, 1, 100, 0) + struct.pack("<I", 4) + b"zstd"
    body += struct.pack("<Q", len(packed)) + packed
    file = tmp_path / "a.mcap"
    file.write_bytes(b"\x89MCAP0\r\n" + struct.pack("<BQ", 6, len(body)) + body)
    tracemalloc.start()
    try:
        McapFile(file)
        assert tracemalloc.get_traced_memory()[1] < 20_000_000
    finally:
        tracemalloc.stop()


def test_a_definition_that_is_too_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is left out, as one in another language is."""
    path = plain_mcap(tmp_path / "a.mcap", [1])
    monkeypatch.setattr(mcap_file, "DEFINITION_BOUND", 12)
    assert McapFile(path).contents.topics["/chatter"].definition == "string data\n"
    monkeypatch.setattr(mcap_file, "DEFINITION_BOUND", 11)
    assert McapFile(path).contents.topics["/chatter"].definition == ""


def test_too_many_channels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Are refused, since each takes memory."""
    path = plain_mcap(tmp_path / "a.mcap", [1])
    monkeypatch.setattr(mcap_file, "CHANNELS_BOUND", 0)
    with pytest.raises(BagError, match=r"a\.mcap: it has more than 0 channels"):
        McapFile(path)
