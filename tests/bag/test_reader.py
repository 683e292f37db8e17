"""Bags as they are read: folders and files, of others and of ourselves, whole and damaged, honest and hostile."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.typesys import Stores, get_typestore

from graphflow.bag import reader
from graphflow.bag.formats.mcap_file import McapFile
from graphflow.bag.reader import Bag
from graphflow.errors import BagError
from tests.bag.cast import CHATTER, COUNT, START, some_records, write
from tests.cases import slow


@pytest.fixture(params=[StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def foreign(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A bag that `rosbags` has written."""
    store = get_typestore(Stores.ROS2_JAZZY)
    folder = tmp_path / "foreign"
    with RosbagsWriter(folder, version=9, storage_plugin=request.param) as writer:
        connections: dict[str, Any] = {
            topic.name: writer.add_connection(topic.name, topic.type, typestore=store) for topic in (CHATTER, COUNT)
        }
        for one in some_records():
            if one.topic.name in connections:
                writer.write(connections[one.topic.name], one.log_ns, one.data)
    return folder


def test_a_bag_of_rosbags(foreign: Path) -> None:
    """Message by message as it was written, by the folder and by the file."""
    expected = [(r.topic.name, r.log_ns, r.data) for r in some_records() if r.topic.name != "/map"]
    [file] = [f for f in foreign.iterdir() if f.suffix in (".mcap", ".db3")]
    for path in (foreign, file):
        bag = Bag(path)
        assert [(r.topic.name, r.log_ns, r.data) for r in bag.records()] == expected
        assert bag.contents.counts == {"/chatter": 20, "/count": 20}
        assert bag.contents.topics["/chatter"].type == "std_msgs/msg/String"
    assert bag.storage == ("sqlite3" if file.suffix == ".db3" else "mcap")


def test_some_of_it(foreign: Path) -> None:
    """Topics, and a time: its beginning belongs to it, its end does not."""
    bag = Bag(foreign)
    found = list(bag.records(["/count"], START + 50_000_000, START + 450_000_000))
    assert [r.log_ns - START for r in found] == [50_000_000, 150_000_000, 250_000_000, 350_000_000]
    assert {r.topic.name for r in found} == {"/count"}
    assert list(bag.records([])) == []
    assert list(bag.records(None, START + 10**12)) == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no FIFOs")
def test_a_bag_that_is_no_file(tmp_path: Path) -> None:
    """It is there, and is neither a file nor a folder."""
    os.mkfifo(tmp_path / "bag.mcap")
    with pytest.raises(BagError, match=r"bag\.mcap: it is not a regular file"):
        _ = Bag(tmp_path / "bag.mcap").contents


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda folder: folder / "nothing", "there is no such file or folder"),
        (lambda folder: folder, "it has no .mcap, .db3 or .bag file"),
        (
            lambda folder: text(folder / "metadata.yaml", "a: 1"),
            "metadata.yaml is a part of the bag; give its folder: ",
        ),
        (lambda folder: text(folder / "a.mcap", "hello"), "a.mcap: it is not an MCAP file"),
        (lambda folder: text(folder / "a.db3", "hello"), "a.db3: it is not an SQLite file"),
        (lambda folder: text(folder / "a.db3", "SQLite format 3\0" + "x" * 200), "a.db3: "),
        (lambda folder: text(folder / "a.mcap.zstd", ""), "a.mcap.zstd: it is empty"),
        (lambda folder: text(folder / "metadata.yaml", "a: [").parent, "metadata.yaml: it is not a bag's metadata"),
        (lambda folder: text(folder / "metadata.yaml", "a: 1").parent, "metadata.yaml: it is not a bag's metadata"),
        (lambda folder: text(folder / "metadata.yaml", "a: &a [x]\nb: *a").parent, "it has aliases"),
        (lambda folder: text(folder / "metadata.yaml", "- 1").parent, "metadata.yaml: it is not a bag's metadata"),
        (
            lambda folder: (
                text(
                    folder / "metadata.yaml", "rosbag2_bagfile_information: {relative_file_paths: [../../x.mcap]}"
                ).parent
            ),
            "it has no .mcap, .db3 or .bag file; its metadata.yaml names x.mcap",
        ),
        (
            lambda folder: (
                text(
                    folder / "metadata.yaml",
                    "rosbag2_bagfile_information: {compression_mode: MESSAGE, compression_format: lzma}",
                ).parent
            ),
            "it is compressed by 'lzma'; graphflow reads zstd, lz4",
        ),
    ],
)
def test_what_is_no_bag(tmp_path: Path, make: Any, message: str) -> None:
    """Each says what it is instead."""
    with pytest.raises(BagError) as caught:
        Bag(make(tmp_path))
    assert message in str(caught.value)


def text(path: Path, content: str) -> Path:
    path.write_text(content)
    return path


def test_a_folder_without_metadata(tmp_path: Path) -> None:
    """Has its files in their order, the tenth behind the ninth."""
    folder = write(tmp_path / "bag", max_seconds=0.1)
    (folder / "metadata.yaml").unlink()
    bag = Bag(folder)
    assert len(bag.files) > 10
    assert [f.path.name for f in bag.files] == [f"bag_{n}.mcap" for n in range(len(bag.files))]
    assert bag.contents.message_count == 41


@slow
def test_many_files_are_not_open_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only those that overlap in time."""
    bag = Bag(write(tmp_path / "bag", max_seconds=0.05))
    assert len(bag.files) > 15
    begun: list[str] = []
    real = McapFile._opened

    def opened(file: McapFile) -> Any:
        begun.append(file.path.name)
        return real(file)

    monkeypatch.setattr(McapFile, "_opened", opened)
    records = bag.records()
    for _ in range(5):
        next(records)
    assert len(begun) < 6
    assert len(list(records)) == 36


@pytest.mark.timeout(20)
def test_files_of_a_bag_that_are_none(tmp_path: Path) -> None:
    """Nobody waits for a FIFO in a bag's folder."""
    folder = tmp_path / "bag"
    folder.mkdir()
    os.mkfifo(folder / "bag_0.mcap")
    with pytest.raises(BagError, match=r"it has no \.mcap, \.db3 or \.bag file"):
        Bag(folder)
    os.mkfifo(folder / "metadata.yaml")
    with pytest.raises(BagError, match=r"metadata\.yaml: it is not a regular file"):
        Bag(folder)


def test_metadata_that_name_too_many_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the names, only so many are looked for."""
    monkeypatch.setattr(reader, "_FILES_BOUND", 1)
    names = "rosbag2_bagfile_information: {relative_file_paths: [a.mcap, b.mcap]}"
    text(tmp_path / "metadata.yaml", names)
    with pytest.raises(BagError, match=r"names a\.mcap$"):
        Bag(tmp_path)
