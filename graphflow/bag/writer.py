"""A bag, written: a folder with `metadata.yaml` and one or more files, MCAP or `.db3`, as rosbag2 makes it.

What is on disk can be read at any time: chunks are closed every half second, and `metadata.yaml` follows, so that a
recorder that is killed loses no more than that.
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
from graphflow.bag.formats.bag_file import Part
from graphflow.bag.formats.db3_writer import Db3Part
from graphflow.bag.formats.mcap_writer import McapWriter
from graphflow.bag.formats.metadata import FileContents
from graphflow.bag.recording.latched import NO_REPEATS, LatchedMessages, Repeats
from graphflow.errors import BagError

logger = logging.getLogger("graphflow")

FLUSH_EVERY = 0.5
"""Seconds that a message may be on its way to the file."""
SYNC_EVERY = 5.0
"""Seconds that what is in the file may be on its way to the disk."""
CHUNK_SIZE = 1 << 20
"""Bytes of messages that are packed together."""
RESERVE = 4 << 20
"""Bytes that are kept free on the disk to finish the bag when it is full."""
_FULL = (errno.ENOSPC, errno.EDQUOT)
COMPRESSIONS = ("zstd", "lz4", "none")
STORAGES = ("mcap", "sqlite3")


class _Stream:
    """A file to which a piece is written whole or not at all, so that it stays readable on a full disk."""

    def __init__(self, path: Path, make_room: Callable[[], bool]) -> None:
        self._file = path.open("xb", buffering=0)
        self._end = 0
        self._make_room = make_room
        self.trouble: OSError | None = None
        """Why no more should be written, though all that was has found room."""

    def _put(self, data: memoryview) -> int:
        return self._file.write(data)

    def write(self, data: bytes | memoryview) -> int:
        left = memoryview(data)
        try:
            while left:
                try:
                    left = left[self._put(left) :]
                except OSError as error:
                    # What the library has handed over it has forgotten: it must find room now.
                    if error.errno not in _FULL or not self._make_room():
                        raise
                    self.trouble = error
        except OSError:
            with contextlib.suppress(OSError):  # what is there of it is taken for the end of the file
                self._file.truncate(self._end)
                self._file.seek(self._end)
            raise
        self._end += len(data)
        return len(data)

    def tell(self) -> int:
        return self._end

    def flush(self) -> None:
        """Nothing is kept back."""

    def sync(self) -> None:
        os.fsync(self._file.fileno())

    def close(self) -> None:
        self._file.close()


class _McapPart(Part):
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

    def finish(self, said: str) -> None:
        self._writer.flush()
        self._writer.add_metadata("rosbag2", {"serialized_metadata": said})
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
        self._writer.add_message(number, record.log_ns, record.data, record.publish_ns, record.sequence % (1 << 32))


class BagWriter:
    """Writes a bag. A context manager.

    Args:
        folder: Made here; there must be none of that name.
        storage: One of `STORAGES`.
        compression: One of `COMPRESSIONS`, of the chunks in an MCAP file.
        max_size: Bytes after which a new file is begun; 0 for never.
        max_seconds: Seconds of recording after which a new file is begun; 0 for never.
        custom: What the user has to say about the bag, for its metadata.
        repeats: Which topics' last messages every new file begins with.
        monotonic_ns: The clock by which files are flushed.

    Raises:
        BagError: The folder is there, or cannot be made.
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
        """Whether the last file is among those that are done."""
        self._sizes = 0
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            raise BagError(f"{folder} is there already; choose another name with -o") from None
        except OSError as error:
            raise BagError(f"{folder}: {error.strerror}") from None
        self._flushed_ns = self._synced_ns = self._now_ns()
        with _told(folder):
            self._reserve = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115 - it ends with the process
            self._reserve.write(bytes(RESERVE))
            self._reserve.flush()
        try:
            self._part = self._next()
            with _told(folder):
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
        """What has been written."""
        return together([file.contents for file in self._files()])

    @property
    def size(self) -> int:
        """Bytes of all files so far."""
        return self._sizes + (0 if self._is_finished else self._part.size)

    def declare(self, topic: Topic) -> None:
        """Say that there is a topic, though it may never have a message."""
        with _told(self.folder):
            self._part.declare(topic)

    def add(self, record: Record) -> None:
        """Write a message.

        Raises:
            BagError: It cannot be written; what is in the bag can be read.
        """
        with _told(self.folder):
            part = self._part
            if (self._max_size and part.written >= self._max_size) or (
                self._max_ns and part.written and record.log_ns - part.start_ns >= self._max_ns
            ):
                self.split()
            if self._is_new:
                self._is_new = False
                for kept in self._kept.before(record.log_ns):
                    self._part.add(kept)
                self._part.written = 0  # what is repeated is no reason for another file
            self._part.add(record)
            self._kept.put(record)
            self._part.check()

    def split(self) -> None:
        """Go on in a new file."""
        with _told(self.folder):
            topics = list(self._part.topics.values())
            self._finish()
            self._part, self._is_finished, self._is_new = self._next(), False, True
            self._write_metadata()
            for topic in topics:
                self._part.declare(topic)

    def keep_up(self) -> None:
        """Put what has been written on disk, where it is time for that. To be called now and then."""
        now_ns = self._now_ns()
        with _told(self.folder):
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
            BagError: The end cannot be written; what is in the bag can be read.
        """
        with _told(self.folder):
            self._reserve.close()
            if not self._is_finished:
                self._finish()
            self._write_metadata()

    def salvage(self) -> None:
        """Finish the bag after an error, if that can be done; else leave it as it is."""
        try:
            self.close()
        except BagError as error:
            logger.warning("%s", error)
            self._part.abandon()

    def _next(self) -> Part:
        with _told(self.folder):
            name = f"{self.folder.name}_{len(self._done)}"
            if self._storage == "sqlite3":
                return Db3Part(self.folder / f"{name}.db3", self._make_room)
            return _McapPart(self.folder / f"{name}.mcap", self._compression, self._make_room)

    def _make_room(self) -> bool:
        """Give back what was kept free on the disk; False if that has been done."""
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
        fresh = self.folder / f".{metadata.FILE}"
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(self.folder / metadata.FILE)


@contextlib.contextmanager
def _told(folder: Path) -> Iterator[None]:
    """Tells an error of the system as one of the bag."""
    try:
        yield
    except OSError as error:
        why = "the disk is full" if error.errno in _FULL else error.strerror or str(error)
        raise BagError(f"{folder}: {why}; what has been recorded can be read") from None
    except sqlite3.Error as error:
        why = "the disk is full" if getattr(error, "sqlite_errorcode", 0) == sqlite3.SQLITE_FULL else str(error)
        raise BagError(f"{folder}: {why}; what has been recorded can be read") from None
