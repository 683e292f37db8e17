"""`.db3` files of rosbag2's storage before MCAP, of several ages."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from graphflow.bag.formats import db3_file
from graphflow.bag.formats.db3_file import Db3File
from graphflow.errors import BagError
from graphflow.qos import Durability, Reliability
from tests.bag.cast import START

HUMBLE_QOS = """\
- history: 1
  depth: 5
  reliability: 2
  durability: 1
  deadline: {sec: 9223372036, nsec: 854775807}
  liveliness: 1
"""


def old(path: Path) -> Path:
    """As Humble wrote it: no hashes, no definitions, QoS in numbers."""
    with closing(sqlite3.connect(path)) as base, base:
        base.executescript(
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT,"
            " offered_qos_profiles TEXT);"
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
        )
        base.execute("INSERT INTO topics VALUES (1, '/a', 'std_msgs/msg/String', 'cdr', ?)", (HUMBLE_QOS,))
        base.execute("INSERT INTO topics VALUES (2, '/b', 'std_msgs/msg/String', 'cdr', '')")
        rows = [(1, START + 2, b"two"), (1, START + 1, b"one"), (9, START, b"of no topic")]
        base.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", rows)
    return path


def test_an_old_one(tmp_path: Path) -> None:
    """Columns that an old schema lacks are empty."""
    file = Db3File(old(tmp_path / "a.db3"))
    assert [(r.log_ns - START, r.data) for r in file.records()] == [(1, b"one"), (2, b"two")]
    assert file.contents.counts == {"/a": 2, "/b": 0}
    topic = file.contents.topics["/a"]
    assert (topic.hash, topic.definition) == ("", "")
    [qos] = topic.qos
    assert (qos.depth, qos.reliability, qos.durability) == (5, Reliability.BEST_EFFORT, Durability.TRANSIENT_LOCAL)


def test_a_new_one(tmp_path: Path) -> None:
    """Hashes and definitions are in it."""
    path = old(tmp_path / "a.db3")
    with closing(sqlite3.connect(path)) as base, base:
        base.execute("ALTER TABLE topics ADD COLUMN type_description_hash TEXT")
        base.execute("UPDATE topics SET type_description_hash = 'RIHS01_aa' WHERE id = 1")
        base.execute(
            "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT, encoding TEXT,"
            " encoded_message_definition TEXT, type_description_hash TEXT)"
        )
        row = ("std_msgs/msg/String", "ros2msg", "string data\n", "")
        base.execute("INSERT INTO message_definitions VALUES (1, ?, ?, ?, ?)", row)
    topic = Db3File(path).contents.topics["/a"]
    assert (topic.hash, topic.definition) == ("RIHS01_aa", "string data\n")


def test_a_base_of_something_else(tmp_path: Path) -> None:
    """Is no bag."""
    path = tmp_path / "a.db3"
    with closing(sqlite3.connect(path)) as base, base:
        base.execute("CREATE TABLE people(name TEXT)")
    with pytest.raises(BagError, match=r"a\.db3: no such table: topics|a\.db3: no such column"):
        Db3File(path)


def test_one_that_is_damaged(tmp_path: Path) -> None:
    """Says so when what is damaged is read."""
    path = old(tmp_path / "a.db3")
    data = bytearray(path.read_bytes())
    data[len(data) // 2 :] = bytes(len(data) - len(data) // 2)
    path.write_bytes(data)
    with pytest.raises(BagError, match=r"a\.db3: "):
        list(Db3File(path).records())


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ((1, START, 5_000_000_000), "it has a damaged message"),
        ((1, START, None), "it has a damaged message"),
        ((1, START, "text"), "it has a damaged message"),
        ((1, -5, b"x"), "it has a damaged message"),
    ],
)
def test_columns_of_other_kinds(tmp_path: Path, row: tuple[object, ...], message: str) -> None:
    """SQLite holds anything anywhere: nothing is taken for a message that is none."""
    path = old(tmp_path / "a.db3")
    with closing(sqlite3.connect(path)) as base, base:
        base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", row)
    with pytest.raises(BagError, match=message):
        list(Db3File(path).records(start_ns=-10))


def test_views_are_no_tables(tmp_path: Path) -> None:
    """They may never end."""
    path = tmp_path / "a.db3"
    with closing(sqlite3.connect(old(path))) as base, base:
        base.execute("DROP TABLE messages")
        endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i AS timestamp FROM n"
        base.execute(f"CREATE VIEW messages AS {endless}")
    with pytest.raises(BagError, match="no such table: messages"):
        Db3File(path)


@pytest.mark.parametrize("rest", ["-wal", "-journal"])
def test_one_that_was_not_closed(tmp_path: Path, rest: str) -> None:
    """Its last messages are in another file: they are not left out in silence."""
    path = old(tmp_path / "a.db3")
    path.with_name(f"a.db3{rest}").touch()
    with pytest.raises(BagError, match=r"it was not closed; let sqlite3 take in its -\w+ file"):
        Db3File(path)


def test_many_topics(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Topics beyond the limit are left out, with their messages."""
    monkeypatch.setattr(db3_file, "_TOPICS_BOUND", 1)
    file = Db3File(old(tmp_path / "a.db3"))
    assert file.contents.counts == {"/a": 2}
