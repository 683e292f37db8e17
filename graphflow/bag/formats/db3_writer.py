"""The writer of `.db3` files, for users whose tools read nothing else.

Messages are buffered until `flush` and written in one short transaction, so that a file that is never closed has whole
messages, and can be read.

Source: rosbag2_storage_sqlite3, version 4 of its schema.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable
from pathlib import Path

from graphflow.bag.contents import Record, Topic
from graphflow.bag.formats import metadata
from graphflow.bag.formats.file_writer import FileWriter
from graphflow.wire.profile import wire_profile

PIECE = 1 << 20
"""Size in bytes of the messages in one transaction."""
SCHEMA = """\
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL,
    offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
    encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
    data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
_VERSION = 4


class Db3Part(FileWriter):
    """A file during writing.

    Args:
        make_room: Releases the reserved disk space; False if it was released before.
    """

    def __init__(self, path: Path, make_room: Callable[[], bool]) -> None:
        super().__init__(path)
        self._make_room = make_room
        self._trouble: sqlite3.Error | None = None
        self._waiting: list[tuple[str, tuple[object, ...]]] = []
        """Statements with their values."""
        self._bytes = 0
        self._types: set[str] = set()
        # SQLite itself would open a file that exists.
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        # Used by one thread after the other: the recorder's after the one that created it.
        self._base = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        self._base.executescript(SCHEMA)
        self._wait("INSERT INTO schema VALUES (?, ?)", _VERSION, wire_profile())

    @property
    def size(self) -> int:
        return self.path.stat().st_size

    def check(self) -> None:
        if self._trouble is not None:
            raise self._trouble

    def flush(self) -> None:
        if not self._waiting:
            return
        try:
            self._write()
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode != sqlite3.SQLITE_FULL or not self._make_room():
                raise
            self._trouble = error
            self._write()
        self._waiting.clear()
        self._bytes = 0

    def sync(self) -> None:
        """Do nothing: SQLite syncs each transaction."""

    def finish(self, text: str) -> None:
        self._wait("INSERT INTO metadata(metadata_version, metadata) VALUES (?, ?)", metadata.VERSION, text)
        self.flush()
        self._base.close()

    def abandon(self) -> None:
        self._base.close()

    def _declare(self, topic: Topic) -> int:
        number = len(self._numbers) + 1
        row = (number, topic.name, topic.type, topic.encoding, metadata.as_text(topic.qos), topic.hash)
        self._wait("INSERT INTO topics VALUES (?, ?, ?, ?, ?, ?)", *row)
        if topic.type not in self._types:
            self._types.add(topic.type)
            self._wait(
                "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition,"
                " type_description_hash) VALUES (?, ?, ?, ?)",
                *(topic.type, "ros2msg" if topic.definition else "unknown", topic.definition, topic.hash),
            )
        return number

    def _add(self, number: int, record: Record) -> None:
        self._wait(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", number, record.log_ns, record.data
        )
        self._bytes += len(record.data)
        if self._bytes >= PIECE:
            self.flush()

    def _wait(self, statement: str, *values: object) -> None:
        self._waiting.append((statement, values))

    def _write(self) -> None:
        self._base.execute("BEGIN IMMEDIATE")
        try:
            for statement, values in self._waiting:
                self._base.execute(statement, values)
            self._base.execute("COMMIT")
        except BaseException:  # cancellation included: no transaction may stay open
            if self._base.in_transaction:
                self._base.execute("ROLLBACK")
            raise
