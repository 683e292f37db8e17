"""One `.db3` file of rosbag2's older storage, read.

Source: rosbag2_storage_sqlite3: tables `topics`, `messages`, `message_definitions`.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterator
from pathlib import Path

from graphflow.bag import metadata
from graphflow.bag.contents import Contents, Record, Topic
from graphflow.errors import BagError

MAGIC = b"SQLite format 3\0"
_TOPICS_BOUND = 10_000


class Db3File:
    """Reads one file.

    Raises:
        BagError: There is no such file, or it is no bag.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            with path.open("rb") as file:
                if file.read(len(MAGIC)) != MAGIC:
                    raise BagError(f"{path}: it is no SQLite file")
            self._base = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
            self._base.text_factory = lambda raw: raw.decode("utf-8", "replace")
            self._topics = self._read_topics()
            ends = self._base.execute("SELECT min(timestamp), max(timestamp) FROM messages").fetchone()
            counted = self._base.execute("SELECT topic_id, count(*) FROM messages GROUP BY topic_id").fetchall()
        except OSError as error:
            raise BagError(f"{path}: {error.strerror}") from None
        except (sqlite3.Error, AttributeError, TypeError, ValueError) as error:
            raise BagError(f"{path}: {error}") from None
        if path.with_name(f"{path.name}-wal").exists():
            raise BagError(f"{path}: it was not closed; let sqlite3 take in its -wal file: sqlite3 {path} .tables")
        counts = dict.fromkeys((topic.name for topic in self._topics.values()), 0)
        for number, count in counted:
            if number in self._topics:
                counts[self._topics[number].name] += count
        start, end = ends if all(isinstance(moment, int) and moment >= 0 for moment in ends) else (0, 0)
        self.contents = Contents({t.name: t for t in self._topics.values()}, counts, start, end)

    def _read_topics(self) -> dict[int, Topic]:
        for table in ("topics", "messages"):
            if not self._base.execute("SELECT 1 FROM sqlite_master WHERE type='table' AND name=?", (table,)).fetchone():
                raise sqlite3.DatabaseError(f"no such table: {table}")
        columns = {row[1] for row in self._base.execute("PRAGMA table_info(topics)")}
        hashes = "type_description_hash" if "type_description_hash" in columns else "''"
        offered = "offered_qos_profiles" if "offered_qos_profiles" in columns else "''"
        rows = self._base.execute(
            f"SELECT id, name, type, serialization_format, {offered}, {hashes} FROM topics LIMIT ?",  # noqa: S608 - two of our own words
            (_TOPICS_BOUND,),
        ).fetchall()
        texts = self._definitions()
        return {
            number: Topic(
                str(name), str(type_), str(hash_ or ""), texts.get(type_, ""), metadata.profiles(qos), str(form)
            )
            for number, name, type_, form, qos, hash_ in rows
        }

    def _definitions(self) -> dict[str, str]:
        if not self._base.execute("SELECT 1 FROM sqlite_master WHERE name = 'message_definitions'").fetchone():
            return {}
        query = "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE encoding = 'ros2msg'"
        return {str(name): str(text) for name, text in self._base.execute(query)}

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]:
        """Messages in the order of their times. Arguments and errors as for `McapFile.records`."""
        wanted = {i: t for i, t in self._topics.items() if names is None or t.name in names}
        query = (
            "SELECT topic_id, timestamp, data FROM messages WHERE timestamp >= ? AND timestamp < ? ORDER BY timestamp"
        )
        try:
            for number, when, data in self._base.execute(
                query, (start_ns, (1 << 63) - 1 if end_ns is None else end_ns)
            ):
                if number not in wanted:
                    continue
                if not isinstance(data, bytes) or not isinstance(when, int) or when < 0:
                    raise BagError(f"{self.path}: it has a message that is none")
                yield Record(wanted[number], when, when, 0, data)
        except sqlite3.Error as error:
            raise BagError(f"{self.path}: {error}") from None
