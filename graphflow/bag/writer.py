"""The writer of bags: a folder with `metadata.yaml` and one or more files, MCAP or `.db3`, as in rosbag2.

The files can be read at any time: chunks are closed every half second, and `metadata.yaml` follows, so that a recorder
that is killed loses no more than that.
"""

from __future__ import annotations

import contextlib
import errno
import logging
import os
import sqlite3
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Self

from graphflow import __version__
from graphflow.bag.contents import Contents, Record, Topic, together
from graphflow.bag.formats import metadata
from graphflow.bag.formats.db3_writer import Db3Part
from graphflow.bag.formats.file_writer import FileWriter
from graphflow.bag.formats.mcap_writer import McapWriter
from graphflow.bag.formats.metadata import FileContents
from graphflow.bag.recording.latched import NO_REPEATS, LatchedMessages, Repeats
from graphflow.errors import BagError

logger = logging.getLogger("graphflow")

FLUSH_EVERY = 0.5
"""Seconds until a message must be in the file."""
SYNC_EVERY = 5.0
"""Seconds until data in the file must be on the disk."""
CHUNK_SIZE = 1 << 20
"""Size of a chunk in bytes."""
RESERVE = 4 << 20
"""Bytes of disk space in reserve, to finish the bag when the disk is full."""
_FULL = (errno.ENOSPC, errno.EDQUOT)
COMPRESSIONS = ("zstd", "lz4", "none")
STORAGES = ("mcap", "sqlite3")


class _Stream:
    """A file whose writes are all or nothing, so that it stays readable on a full disk."""

    def __init__(self, path: Path, make_room: Callable[[], bool]) -> None:
        # Unbuffered, so that an error tells how much of this very write has reached the file.
        self._file = path.open("xb", buffering=0)
        self._end = 0
        self._make_room = make_room
        self.trouble: OSError | None = None
        """Reason to write no more, although all data so far found room."""

    def _put(self, data: memoryview) -> int:
        return self._file.write(data)

    def write(self, data: bytes | memoryview) -> int:
        left = memoryview(data)
        try:
            while left:
                try:
                    left = left[self._put(left) :]
                except OSError as error:
                    # The library has forgotten the data it passed: they must find room now.
                    if error.errno not in _FULL or not self._make_room():
                        raise
                    self.trouble = error
        except OSError:
            with contextlib.suppress(OSError):  # a partial record would count as the end of the file
                self._file.truncate(self._end)
                self._file.seek(self._end)
            raise
        self._end += len(data)
        return len(data)

    def tell(self) -> int:
        return self._end

    def flush(self) -> None:
        """Do nothing: there is no buffer."""

    def sync(self) -> None:
        os.fsync(self._file.fileno())

    def close(self) -> None:
        self._file.close()


class _McapPart(FileWriter):
    """An MCAP file."""

    def __init__(self, path: Path, compression: str, make_room: Callable[[], bool]) -> None:
        super().__init__(path)
        self._file = _Stream(path, make_room)
        library = f"graphflow {__version__}"
        self._writer = McapWriter(self._file, library, chunk_size=CHUNK_SIZE, compression=compression)
        self._schemas: dict[tuple[str, str], int] = {}

    @property
    def size(self) -> int:
        return self._file.tell()

    def check(self) -> None:
        if self._file.trouble is not None:
            raise self._file.trouble

    def flush(self) -> None:
        self._writer.flush()

    def sync(self) -> None:
        self._file.sync()

    def finish(self, text: str) -> None:
        self._writer.flush()
        self._writer.add_metadata("rosbag2", {"serialized_metadata": text})
        self._writer.finish()
        self._file.sync()
        self._file.close()

    def abandon(self) -> None:
        self._file.close()

    def _declare(self, topic: Topic) -> int:
        key = (topic.type, topic.definition)
        if key not in self._schemas:
            form = "ros2msg" if topic.definition else ""
            self._schemas[key] = self._writer.register_schema(topic.type, form, topic.definition.encode())
        about = {"offered_qos_profiles": metadata.as_text(topic.qos), "topic_type_hash": topic.hash}
        return self._writer.register_channel(topic.name, topic.encoding, self._schemas[key], about)

    def _add(self, number: int, record: Record) -> None:
        # MCAP's sequence number is a uint32.
        self._writer.add_message(number, record.log_ns, record.data, record.publish_ns, record.sequence % (1 << 32))


class BagWriter:
    """A bag to write, as a context manager.

    Args:
        folder: Created; must not exist.
        storage: One of `STORAGES`.
        compression: One of `COMPRESSIONS`, of the chunks in an MCAP file.
        max_size: Size in bytes after which a new file starts; 0 for none.
        max_seconds: Seconds of recording after which a new file starts; 0 for none.
        custom: The user's own metadata.
        repeats: The topics whose last messages begin every new file.
        monotonic_ns: The clock that schedules flushes.

    Raises:
        BagError: The folder exists, or cannot be created.
    """

    def __init__(
        self,
        folder: Path,
        *,
        storage: str = "mcap",
        compression: str = "zstd",
        max_size: int = 0,
        max_seconds: float = 0.0,
        custom: Mapping[str, str] | None = None,
        repeats: Repeats = NO_REPEATS,
        monotonic_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self.folder = folder
        self._custom = custom or {}
        self._compression = "" if compression == "none" else compression
        self._max_size, self._max_ns = max_size, round(max_seconds * 1e9)
        self._now_ns = monotonic_ns
        self._storage = storage
        self.repeats = repeats
        self._kept, self._is_new = LatchedMessages(repeats), False
        self._done: list[FileContents] = []
        self._is_finished = False
        """Whether the last file is finished."""
        self._sizes = 0
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            raise BagError(f"{folder} exists already; choose another name with -o") from None
        except OSError as error:
            raise BagError(f"{folder}: {error.strerror}") from None
        self._flushed_ns = self._synced_ns = self._now_ns()
        with _bag_errors(folder):
            self._reserve = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115 - it ends with the process
            # Written in full, since a sparse file would reserve nothing.
            self._reserve.write(bytes(RESERVE))
            self._reserve.flush()
        try:
            self._part = self._next()
            with _bag_errors(folder):
                self._write_metadata()
        except BagError:
            self._reserve.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def contents(self) -> Contents:
        """The contents written so far."""
        return together([file.contents for file in self._files()])

    @property
    def size(self) -> int:
        """The size of all files so far in bytes."""
        return self._sizes + (0 if self._is_finished else self._part.size)

    def declare(self, topic: Topic) -> None:
        """Add a topic, which may never have a message."""
        with _bag_errors(self.folder):
            self._part.declare(topic)

    def add(self, record: Record) -> None:
        """Write a message.

        Raises:
            BagError: It cannot be written; the bag so far can be read.
        """
        with _bag_errors(self.folder):
            part = self._part
            if (self._max_size and part.written >= self._max_size) or (
                self._max_ns and part.written and record.log_ns - part.start_ns >= self._max_ns
            ):
                self.split()
            if self._is_new:
                self._is_new = False
                for kept in self._kept.before(record.log_ns):
                    self._part.add(kept)
                self._part.written = 0  # repeated messages must not cause another file
            self._part.add(record)
            self._kept.put(record)
            self._part.check()

    def split(self) -> None:
        """Continue in a new file."""
        with _bag_errors(self.folder):
            topics = list(self._part.topics.values())
            self._finish()
            self._part, self._is_finished, self._is_new = self._next(), False, True
            self._write_metadata()
            for topic in topics:
                self._part.declare(topic)

    def keep_up(self) -> None:
        """Flush and sync what is due. To be called regularly."""
        now_ns = self._now_ns()
        with _bag_errors(self.folder):
            if now_ns - self._flushed_ns >= FLUSH_EVERY * 1e9:
                self._flushed_ns = now_ns
                self._part.flush()
                self._part.check()
            if now_ns - self._synced_ns >= SYNC_EVERY * 1e9:
                self._synced_ns = now_ns
                self._part.sync()
                self._write_metadata()

    def close(self) -> None:
        """Finish the bag.

        Raises:
            BagError: The end cannot be written; the bag so far can be read.
        """
        with _bag_errors(self.folder):
            # First: the end of the bag may need its room.
            self._reserve.close()
            if not self._is_finished:
                self._finish()
            self._write_metadata()

    def salvage(self) -> None:
        """Finish the bag after an error, if possible; else leave it as it is."""
        try:
            self.close()
        except BagError as error:
            logger.warning("%s", error)
            self._part.abandon()

    def _next(self) -> FileWriter:
        with _bag_errors(self.folder):
            name = f"{self.folder.name}_{len(self._done)}"
            if self._storage == "sqlite3":
                return Db3Part(self.folder / f"{name}.db3", self._make_room)
            return _McapPart(self.folder / f"{name}.mcap", self._compression, self._make_room)

    def _make_room(self) -> bool:
        """Release the reserved disk space; False if it was released before."""
        if self._reserve.closed:
            return False
        self._reserve.close()
        return True

    def _finish(self) -> None:
        mine = FileContents(self._part.path.name, self._part.contents)
        self._part.finish(metadata.written([mine], mine.contents, self._custom, self._storage))
        self._sizes += self._part.size
        self._done.append(mine)
        self._is_finished = True

    def _files(self) -> list[FileContents]:
        more = [] if self._is_finished else [FileContents(self._part.path.name, self._part.contents)]
        return [*self._done, *more]

    def _write_metadata(self) -> None:
        files = self._files()
        text = metadata.written(files, together([file.contents for file in files]), self._custom, self._storage)
        # Replaced in one step: nobody, not even after a kill, finds half of it.
        fresh = self.folder / f".{metadata.FILE}"
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(self.folder / metadata.FILE)


@contextlib.contextmanager
def _bag_errors(folder: Path) -> Iterator[None]:
    """Convert an OSError to a BagError."""
    try:
        yield
    except OSError as error:
        why = "the disk is full" if error.errno in _FULL else error.strerror or str(error)
        raise BagError(f"{folder}: {why}; what has been recorded can be read") from None
    except sqlite3.Error as error:
        why = "the disk is full" if getattr(error, "sqlite_errorcode", 0) == sqlite3.SQLITE_FULL else str(error)
        raise BagError(f"{folder}: {why}; what has been recorded can be read") from None
