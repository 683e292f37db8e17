"""The reader of `.db3` files, rosbag2's older storage.

Source: rosbag2_storage_sqlite3: tables `topics`, `messages`, `message_definitions`.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterator
from contextlib import closing
from pathlib import Path

from graphflow.bag.contents import Contents, Record, Topic
from graphflow.bag.formats import metadata
from graphflow.errors import BagError

MAGIC = b"SQLite format 3\0"
_TOPICS_BOUND = 10_000


class Db3File:
    """One file.

    Raises:
        BagError: There is no such file, or it is not a bag.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            with path.open("rb") as file:
                if file.read(len(MAGIC)) != MAGIC:
                    raise BagError(f"{path}: it is not an SQLite file")
            with closing(self._open()) as base:
                self._topics = _read_topics(base)
                ends = base.execute("SELECT min(timestamp), max(timestamp) FROM messages").fetchone()
                counted = base.execute("SELECT topic_id, count(*) FROM messages GROUP BY topic_id").fetchall()
        except OSError as error:
            raise BagError(f"{path}: {error.strerror}") from None
        except (sqlite3.Error, AttributeError, TypeError, ValueError) as error:
            raise BagError(f"{path}: {error}") from None
        for rest in ("-wal", "-journal"):  # the latest messages, and an interrupted transaction
            if path.with_name(path.name + rest).exists():
                raise BagError(
                    f"{path}: it was not closed; let sqlite3 take in its {rest} file: sqlite3 {path} .tables"
                )
        counts = dict.fromkeys((topic.name for topic in self._topics.values()), 0)
        for number, count in counted:
            if number in self._topics:
                counts[self._topics[number].name] += count
        start, end = ends if all(isinstance(moment, int) and moment >= 0 for moment in ends) else (0, 0)
        self.contents = Contents({t.name: t for t in self._topics.values()}, counts, start, end)

    def _open(self) -> sqlite3.Connection:
        # Without `immutable`, SQLite would create files beside a bag in WAL mode, whose folder may be read-only. With
        # it, SQLite ignores the two files that are refused above.
        base = sqlite3.connect(f"{self.path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
        base.text_factory = lambda raw: raw.decode("utf-8", "replace")
        return base

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]:
        """Yield messages in the order of their times. Arguments and errors as for `McapFile.records`."""
        wanted = {i: t for i, t in self._topics.items() if names is None or t.name in names}
        query = (
            "SELECT topic_id, timestamp, data FROM messages WHERE timestamp >= ? AND timestamp < ? ORDER BY timestamp"
        )
        span = (start_ns, (1 << 63) - 1 if end_ns is None else end_ns)
        try:
            with closing(self._open()) as base:
                for number, when, data in base.execute(query, span):
                    if number not in wanted:
                        continue
                    if not isinstance(data, bytes) or not isinstance(when, int) or when < 0:
                        raise BagError(f"{self.path}: it has a damaged message")
                    yield Record(wanted[number], when, when, 0, data)
        except sqlite3.Error as error:
            raise BagError(f"{self.path}: {error}") from None


def _read_topics(base: sqlite3.Connection) -> dict[int, Topic]:
    for table in ("topics", "messages"):
        if not base.execute("SELECT 1 FROM sqlite_master WHERE type='table' AND name=?", (table,)).fetchone():
            raise sqlite3.DatabaseError(f"no such table: {table}")
    columns = {row[1] for row in base.execute("PRAGMA table_info(topics)")}
    hashes = "type_description_hash" if "type_description_hash" in columns else "''"
    offered = "offered_qos_profiles" if "offered_qos_profiles" in columns else "''"
    rows = base.execute(
        f"SELECT id, name, type, serialization_format, {offered}, {hashes} FROM topics LIMIT ?",  # noqa: S608 - two of our own texts
        (_TOPICS_BOUND,),
    ).fetchall()
    texts = _definitions(base)
    return {
        number: Topic(str(name), str(type_), str(hash_ or ""), texts.get(type_, ""), metadata.profiles(qos), str(form))
        for number, name, type_, form, qos, hash_ in rows
    }


def _definitions(base: sqlite3.Connection) -> dict[str, str]:
    if not base.execute("SELECT 1 FROM sqlite_master WHERE name = 'message_definitions'").fetchone():
        return {}
    query = "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE encoding = 'ros2msg'"
    return {str(name): str(text) for name, text in base.execute(query)}
