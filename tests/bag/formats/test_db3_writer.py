"""`.db3` files as they are written: what others read of them, and what is left after an accident."""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import yaml
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from graphflow.bag.formats import db3_writer
from graphflow.bag.formats.db3_file import Db3File
from graphflow.bag.formats.db3_writer import Db3Part
from graphflow.bag.reader import Bag
from graphflow.bag.writer import BagWriter
from graphflow.errors import BagError
from tests.bag.cast import CHATTER, COUNT, LAB, THING, record, some_records, write


def raw_of(path: Path) -> list[tuple[str, int, bytes]]:
    return [(r.topic.name, r.log_ns, r.data) for r in Bag(path).records()]


EXPECTED = sorted(((r.topic.name, r.log_ns, r.data) for r in some_records()), key=lambda said: said[1])


@pytest.mark.parametrize("options", [{}, {"max_size": 100}])
def test_what_is_written_is_read(tmp_path: Path, options: dict[str, Any]) -> None:
    """Message by message, in one file or several, with hashes, definitions and QoS."""
    folder = write(tmp_path / "bag", storage="sqlite3", **options)
    bag = Bag(folder)
    assert raw_of(folder) == EXPECTED
    assert bag.storage == "sqlite3"
    assert (len(bag.files) > 4) == bool(options)
    assert bag.contents.topics["/chatter"] == CHATTER
    said = yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert (said["storage_identifier"], said["message_count"]) == ("sqlite3", 41)
    assert said["relative_file_paths"][0] == "bag_0.db3"
    assert not list(folder.glob("*-journal"))


def test_rosbags_reads_it(tmp_path: Path) -> None:
    """With no type known to it beforehand: the bag has the definitions."""
    folder = write(tmp_path / "bag", [*some_records(), record(LAB, THING, 5.0)], storage="sqlite3")
    with AnyReader([folder], default_typestore=get_typestore(Stores.EMPTY)) as reader:
        assert [(c.topic, t, bytes(raw)) for c, t, raw in reader.messages()][:-1] == EXPECTED
        last: Any = [reader.deserialize(raw, c.msgtype) for c, _, raw in reader.messages()][-1]
        assert (last.x, list(last.part.y)) == (7, [1, 2])
    with closing(sqlite3.connect(folder / "bag_0.db3")) as base:
        [(version, text)] = base.execute("SELECT metadata_version, metadata FROM metadata").fetchall()
        assert (version, yaml.safe_load(text)["rosbag2_bagfile_information"]["message_count"]) == (9, 42)
        assert base.execute("SELECT schema_version FROM schema").fetchall() == [(4,)]


def test_one_that_is_never_closed(tmp_path: Path) -> None:
    """Has whole messages: all up to the last flush."""
    part = Db3Part(tmp_path / "a.db3", lambda: False)
    for n, one in enumerate(some_records()):
        part.add(one)
        if n == 30:
            part.flush()
    shutil.copy(tmp_path / "a.db3", tmp_path / "b.db3")
    part.abandon()
    assert Db3File(tmp_path / "b.db3").contents.message_count == 31


@pytest.mark.parametrize("reserve", [100, 0])
def test_a_full_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, reserve: int) -> None:
    """It is told; with what was kept free for that, nothing is lost that was added; what is there can be read."""
    monkeypatch.setattr(db3_writer, "PIECE", 3000)
    writer = BagWriter(tmp_path / "bag", storage="sqlite3")
    part: Any = writer._part

    def make_room() -> bool:
        part._base.execute(f"PRAGMA max_page_count={30 + reserve}")
        return bool(reserve)

    part._make_room = make_room
    part._base.execute("PRAGMA max_page_count=30")
    added = 0
    with pytest.raises(BagError, match="bag: the disk is full; what has been recorded can be read"):
        for n in range(1000):
            added += 1
            writer.add(record(COUNT, bytes(500), n / 10, n))
    writer.salvage()
    count = Bag(tmp_path / "bag").contents.message_count
    assert count == added if reserve else 20 < count < added


def test_a_file_that_is_there(tmp_path: Path) -> None:
    """Is not written into."""
    (tmp_path / "a.db3").touch()
    with pytest.raises(FileExistsError):
        Db3Part(tmp_path / "a.db3", lambda: False)
