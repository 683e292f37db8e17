"""Bags as they are written: files, metadata, what others read of them, and what is left after an accident."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import pytest
import yaml
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from graphflow.bag import writer as module
from graphflow.bag.contents import Record
from graphflow.bag.reader import Bag
from graphflow.bag.writer import COMPRESSIONS, BagWriter
from graphflow.errors import BagError
from graphflow.msgs import registry
from graphflow.msgs.std_msgs.msg import String
from tests.bag.cast import CHATTER, COUNT, LAB, START, THING, record, some_records, write
from tests.cases import slow


class Clock:
    def __init__(self) -> None:
        self.now_ns = 0

    def __call__(self) -> int:
        return self.now_ns


def raw_of(records: list[Record]) -> list[tuple[str, int, bytes]]:
    return [(r.topic.name, r.log_ns, r.data) for r in sorted(records, key=lambda r: r.log_ns)]


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_what_is_written_is_read(tmp_path: Path, compression: str) -> None:
    """Every message as it was, in the order of their times, with the whole of its topic."""
    records = some_records()
    bag = Bag(write(tmp_path / "bag", records, compression=compression))
    assert list(bag.records()) == sorted(records, key=lambda r: r.log_ns)
    assert bag.contents.is_whole
    assert bag.contents.counts == {"/map": 1, "/chatter": 20, "/count": 20}
    assert (bag.contents.start_ns, bag.contents.end_ns) == (START, START + 1_950_000_000)


@slow
@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_rosbags_reads_it(tmp_path: Path, compression: str) -> None:
    """The folder and the file, with no type known to it beforehand: the bag has the definitions."""
    records = [*some_records(), record(LAB, THING, 5.0)]
    folder = write(tmp_path / "bag", records, compression=compression)
    for path in (folder, folder / "bag_0.mcap"):
        with AnyReader([path], default_typestore=get_typestore(Stores.EMPTY)) as reader:
            found: list[Any] = [(c.topic, t, bytes(raw)) for c, t, raw in reader.messages()]
            assert found == raw_of(records)
            last: Any = [reader.deserialize(raw, c.msgtype) for c, _, raw in reader.messages()][-1]
            assert (last.x, list(last.part.y)) == (7, [1, 2])
            assert reader.topics["/chatter"].msgtype == "std_msgs/msg/String"


def test_mcaps_own_reader_finds_nothing_wrong(tmp_path: Path) -> None:
    """By the index and record by record, checksums and all."""
    file = write(tmp_path / "bag") / "bag_0.mcap"
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert reader.get_header().profile == "ros2"
        assert len(list(reader.iter_messages())) == 41
        summary = reader.get_summary()
        assert summary is not None
        [channel] = [c for c in summary.channels.values() if c.topic == "/map"]
        assert "durability: transient_local" in channel.metadata["offered_qos_profiles"]
        assert channel.metadata["topic_type_hash"] == registry.hash_of("std_msgs/msg/String")
        [said] = list(reader.iter_metadata())
        assert (
            yaml.safe_load(said.metadata["serialized_metadata"])["rosbag2_bagfile_information"]["message_count"] == 41
        )
    with file.open("rb") as stream:
        assert len(list(StreamReader(stream, validate_crcs=True).records)) > 41


def test_metadata(tmp_path: Path) -> None:
    """As rosbag2 writes it."""
    folder = write(tmp_path / "bag")
    said = yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert (said["version"], said["storage_identifier"], said["message_count"]) == (9, "mcap", 41)
    assert said["starting_time"] == {"nanoseconds_since_epoch": START}
    assert said["duration"] == {"nanoseconds": 1_950_000_000}
    assert said["relative_file_paths"] == ["bag_0.mcap"]
    topics = {t["topic_metadata"]["name"]: t for t in said["topics_with_message_count"]}
    assert topics["/chatter"]["message_count"] == 20
    assert topics["/chatter"]["topic_metadata"]["type_description_hash"] == registry.hash_of("std_msgs/msg/String")
    assert topics["/map"]["topic_metadata"]["offered_qos_profiles"][0]["durability"] == "transient_local"
    assert sorted(f.name for f in folder.iterdir()) == ["bag_0.mcap", "metadata.yaml"]


def test_a_topic_without_messages(tmp_path: Path) -> None:
    """Is in the bag when it was declared."""
    with BagWriter(tmp_path / "bag") as writer:
        writer.declare(CHATTER)
    assert Bag(tmp_path / "bag").contents.counts == {"/chatter": 0}


@pytest.mark.parametrize("options", [{"max_size": 100}, {"max_seconds": 0.5}])
def test_several_files(tmp_path: Path, options: dict[str, Any]) -> None:
    """Each can be read by itself, and all of them are one bag."""
    records = some_records()
    folder = write(tmp_path / "bag", records, **options)
    bag = Bag(folder)
    assert len(bag.files) >= 4
    assert [f.name for f in bag.parts] == [f"bag_{n}.mcap" for n in range(len(bag.files))]
    assert raw_of(list(bag.records())) == raw_of(records)
    assert sum(Bag(file.path).contents.message_count for file in bag.files) == 41
    with AnyReader([folder]) as reader:
        assert reader.message_count == 41


def test_a_folder_that_is_there(tmp_path: Path) -> None:
    """Is not touched."""
    write(tmp_path / "bag")
    with pytest.raises(BagError, match="bag exists already; choose another name with -o"):
        BagWriter(tmp_path / "bag")
    assert Bag(tmp_path / "bag").contents.message_count == 41


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    """Says why."""
    (tmp_path / "file").touch()
    with pytest.raises(BagError, match="Not a directory"):
        BagWriter(tmp_path / "file" / "bag")


def copied(folder: Path, to: Path) -> Bag:
    """The bag as it is on disk now, as a kill would leave it."""
    to.mkdir()
    for file in folder.iterdir():
        (to / file.name).write_bytes(file.read_bytes())
    return Bag(to)


def test_a_recorder_that_is_killed_loses_half_a_second(tmp_path: Path) -> None:
    """All that was written before the last flush can be read; the rest was not promised."""
    clock = Clock()
    writer = BagWriter(tmp_path / "bag", monotonic_ns=clock)
    for n, one in enumerate(some_records()):
        clock.now_ns = round(one.log_ns - START)
        writer.add(one)
        writer.keep_up()
        if n % 7 == 0:
            bag = copied(tmp_path / "bag", tmp_path / f"at{n}")
            assert not bag.contents.is_whole
            there = bag.contents.end_ns if bag.contents.message_count else START
            assert one.log_ns - there <= 600_000_000
            assert len(list(bag.records())) == bag.contents.message_count
    writer.close()
    assert Bag(tmp_path / "bag").contents.is_whole


class Full:
    """A disk that takes so many bytes, and as many as the reserve when that has been given back."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, room: int, reserve: int) -> None:
        self.room = room
        real = module._Stream._put

        def put(stream: Any, data: memoryview) -> int:
            taken = data[: self.room]
            if not taken:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            self.room -= len(taken)
            return real(stream, taken)

        def make_room(writer: BagWriter) -> bool:
            nonlocal reserve
            self.room, reserve = self.room + reserve, 0
            return self.room > 0

        monkeypatch.setattr(module._Stream, "_put", put)
        monkeypatch.setattr(BagWriter, "_make_room", make_room)


@pytest.mark.parametrize("room", [1000, 10_000, 20_001, 25_555])
def test_a_full_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, room: int) -> None:
    """It is told; with what was kept free for that the bag is finished, with nothing lost that was added."""
    Full(monkeypatch, room, 100_000)
    monkeypatch.setattr(module, "CHUNK_SIZE", 3000)
    writer = BagWriter(tmp_path / "bag", compression="none")
    added = 0
    with pytest.raises(BagError, match="bag: the disk is full; what has been recorded can be read"):
        for n in range(1000):
            added += 1
            writer.add(record(COUNT, os.urandom(500), n / 10, n))
    writer.salvage()
    bag = Bag(tmp_path / "bag")
    assert bag.contents.is_whole
    assert len(list(bag.records())) == bag.contents.message_count == added


def test_a_disk_that_stays_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Earlier messages can be read."""
    Full(monkeypatch, 20_000, 0)
    monkeypatch.setattr(module, "CHUNK_SIZE", 3000)
    writer = BagWriter(tmp_path / "bag", compression="none")
    with pytest.raises(BagError):
        for n in range(1000):
            writer.add(record(CHATTER, String(data="x" * 500), n / 10, n))
    writer.salvage()
    bag = Bag(tmp_path / "bag")
    assert not bag.contents.is_whole
    assert len(list(bag.records())) == bag.contents.message_count > 20


def test_the_metadata_of_a_bag_that_grows(tmp_path: Path) -> None:
    """Follow it, every five seconds."""
    clock = Clock()
    writer = BagWriter(tmp_path / "bag", monotonic_ns=clock)
    for seconds in (1, 6):
        writer.add(record(CHATTER, String(data="a"), seconds))
        clock.now_ns = seconds * 10**9
        writer.keep_up()
        said = yaml.safe_load((tmp_path / "bag" / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
        assert said["message_count"] == (0 if seconds < 5 else 2)
    writer.close()
