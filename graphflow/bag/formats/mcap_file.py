"""The reader of MCAP files: by the index if a file was closed properly, else record by record as far as possible.

Files are not trusted: sizes in them are checked before memory is allocated.

Source: the MCAP specification, "Records".
"""

from __future__ import annotations

import heapq
import struct
import zlib
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

from graphflow.bag.contents import Contents, Record, Topic
from graphflow.bag.formats import compression, metadata
from graphflow.errors import BagError

MAGIC = b"\x89MCAP0\r\n"
RECORD_BOUND = 1 << 30
"""Largest size in bytes of a record, and of a decompressed chunk."""
DEFINITION_BOUND = 1_000_000
CHANNELS_BOUND = 10_000
_HEAD = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")
_CHUNK = struct.Struct("<QQQI")
_FOOTER = struct.Struct("<QQI")
SCHEMA, CHANNEL, MESSAGE, CHUNK, STATISTICS, CHUNK_INDEX, DATA_END, FOOTER = 3, 4, 5, 6, 0x0B, 0x08, 0x0F, 0x02


_OF_SUMMARY = {SCHEMA, CHANNEL, STATISTICS, CHUNK_INDEX, *(0x0A, 0x0D, 0x0E)}
"""Opcodes allowed in a summary; the last are the indexes of attachments, metadata, and of the summary itself."""


class _Broken(Exception):
    """The file ends here, or continues with data that are not a record."""


class _Block(NamedTuple):
    """A chunk, or a message outside of chunks."""

    start_ns: int
    end_ns: int
    offset: int
    """Offset of its record."""


_Waiting = tuple[int, tuple[int, int], int, int, int, bytes]
"""A message in the merge: its time, its place in the file, channel, sequence number, time of sending, data."""


class McapFile:
    """One file.

    Raises:
        BagError: There is no such file, or it is not MCAP.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._schemas: dict[int, tuple[str, str, bytes]] = {}
        """Name, encoding and text by id."""
        self._channels: dict[int, Topic] = {}
        self._counts: dict[int, int] = {}
        self._blocks: list[_Block] = []
        self._start_ns = self._end_ns = 0
        with self._opened() as file:
            self.is_whole = self._read_index(file)
            if not self.is_whole:
                self._read_through(file)

    def _opened(self) -> BinaryIO:
        try:
            file = self.path.open("rb")
        except OSError as error:
            raise BagError(f"{self.path}: {error.strerror}") from None
        if file.read(len(MAGIC)) != MAGIC:
            file.close()
            raise BagError(f"{self.path}: it is not an MCAP file; a bag is a folder, an .mcap, .db3 or .bag file")
        return file

    @property
    def contents(self) -> Contents:
        topics, counts = dict[str, Topic](), dict[str, int]()
        for number, topic in self._channels.items():
            topics.setdefault(topic.name, topic)
            counts[topic.name] = counts.get(topic.name, 0) + self._counts.get(number, 0)
        return Contents(topics, counts, self._start_ns, self._end_ns, self.is_whole)

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]:
        """Yield messages in the order of their times.

        Args:
            names: Topics; None for all.
            start_ns: Earliest time, nanoseconds since 1970.
            end_ns: Time before which messages are read.

        Raises:
            BagError: A chunk cannot be decompressed.
        """
        wanted = {i: t for i, t in self._channels.items() if names is None or t.name in names}
        end = (1 << 63) if end_ns is None else end_ns
        blocks = sorted(block for block in self._blocks if block.end_ns >= start_ns and block.start_ns < end)
        waiting: list[_Waiting] = []
        with self._opened() as file:
            for block in blocks:
                # Chunks may overlap in time: only messages older than the next chunk are certain to be next.
                while waiting and waiting[0][0] < block.start_ns:
                    yield _record(heapq.heappop(waiting), wanted)
                for number, (channel, sequence, log_ns, publish_ns, data) in enumerate(self._messages(file, block)):
                    if channel in wanted and start_ns <= log_ns < end:
                        place = block.offset, number  # keeps the file's order among messages of one time
                        heapq.heappush(waiting, (log_ns, place, channel, sequence, publish_ns, data))
        while waiting:
            yield _record(heapq.heappop(waiting), wanted)

    # the index

    def _read_index(self, file: BinaryIO) -> bool:
        """Read the summary at the end; False if there is no complete one."""
        from mcap.exceptions import McapError
        from mcap.reader import SeekingReader

        try:
            self._check_summary(file)
            file.seek(0)
            summary = SeekingReader(file, record_size_limit=RECORD_BOUND).get_summary()
        except (_Broken, McapError, ValueError, struct.error, OSError, MemoryError, KeyError, OverflowError):
            return False
        numbers = None if summary is None else summary.statistics
        if summary is None or numbers is None or len(summary.channels) != numbers.channel_count:
            return False
        if numbers.message_count and not summary.chunk_indexes:  # without chunks there is no index of messages
            return False
        for schema in summary.schemas.values():
            self._schemas[schema.id] = (schema.name, schema.encoding, schema.data)
        for channel in summary.channels.values():
            self._add_channel(channel.id, channel.schema_id, channel.topic, channel.message_encoding, channel.metadata)
        self._counts = dict(numbers.channel_message_counts)
        if numbers.message_count:
            self._start_ns, self._end_ns = numbers.message_start_time, numbers.message_end_time
        self._blocks = [
            _Block(c.message_start_time, c.message_end_time, c.chunk_start_offset)
            for c in {c.chunk_start_offset: c for c in summary.chunk_indexes}.values()
        ]
        return True

    def _check_summary(self, file: BinaryIO) -> None:
        """Check that a summary has nothing but an index: a chunk there would be decompressed whatever its size."""
        end = file.seek(0, 2) - len(MAGIC) - _HEAD.size - _FOOTER.size
        file.seek(max(end, 0))
        kind, _ = self._head(file)
        start, _, _ = _FOOTER.unpack(_exactly(file, _FOOTER.size))
        if kind != FOOTER or not 0 < start <= end:
            raise _Broken
        file.seek(start)
        while file.tell() < end:
            kind, size = self._head(file)
            if kind not in _OF_SUMMARY:
                raise _Broken
            file.seek(size, 1)

    def _add_channel(self, number: int, schema: int, topic: str, encoding: str, about: dict[str, str]) -> None:
        if len(self._channels) >= CHANNELS_BOUND:
            raise BagError(f"{self.path}: it has more than {CHANNELS_BOUND:,} channels")
        name, form, text = self._schemas.get(schema, ("", "", b""))
        is_ros = form == "ros2msg" and len(text) <= DEFINITION_BOUND
        definition = text.decode("utf-8", "replace") if is_ros else ""
        offered = metadata.profiles(about.get("offered_qos_profiles", ""))
        self._channels[number] = Topic(topic, name, about.get("topic_type_hash", ""), definition, offered, encoding)

    # record by record

    def _read_through(self, file: BinaryIO) -> None:
        """Read all records, as far as possible."""
        self._schemas.clear()
        self._channels.clear()
        file.seek(len(MAGIC))
        try:
            while True:
                offset = file.tell()
                kind, size = self._head(file)
                if kind == CHUNK:
                    file.seek(offset)
                    self._read_chunk(file, offset)
                elif kind == MESSAGE:
                    body = _exactly(file, size)
                    channel, _, log_ns, _ = _MESSAGE.unpack_from(body)
                    self._count(channel, log_ns)
                    self._blocks.append(_Block(log_ns, log_ns, offset))
                elif kind in (SCHEMA, CHANNEL):
                    self._declare(kind, _exactly(file, size))
                elif kind == FOOTER:
                    self.is_whole = True
                    return
                # No opcode: a file system fills with zeros what a crash has kept from being written.
                elif kind == 0:
                    raise _Broken
                else:
                    file.seek(size, 1)
        except (_Broken, struct.error, UnicodeDecodeError):
            return

    def _read_chunk(self, file: BinaryIO, offset: int) -> None:
        times: list[int] = []
        for kind, body in _parts(self._unpacked(file)):
            if kind == MESSAGE:
                channel, _, log_ns, _ = _MESSAGE.unpack_from(body)
                self._count(channel, log_ns)
                times.append(log_ns)
            elif kind in (SCHEMA, CHANNEL):
                self._declare(kind, bytes(body))
        if times:
            self._blocks.append(_Block(min(times), max(times), offset))

    def _count(self, channel: int, log_ns: int) -> None:
        is_first = not self._counts
        self._counts[channel] = self._counts.get(channel, 0) + 1
        self._start_ns = log_ns if is_first else min(self._start_ns, log_ns)
        self._end_ns = max(self._end_ns, log_ns)

    def _declare(self, kind: int, body: bytes) -> None:
        from io import BytesIO

        from mcap.data_stream import ReadDataStream
        from mcap.exceptions import McapError
        from mcap.records import Channel, Schema

        stream = ReadDataStream(BytesIO(body))
        try:
            if kind == SCHEMA:
                schema = Schema.read(stream)
                self._schemas[schema.id] = (schema.name, schema.encoding, schema.data)
            else:
                c = Channel.read(stream)
                if c.id not in self._channels:
                    self._add_channel(c.id, c.schema_id, c.topic, c.message_encoding, c.metadata)
        except McapError:
            raise _Broken from None

    # reading

    @staticmethod
    def _head(file: BinaryIO) -> tuple[int, int]:
        kind, size = _HEAD.unpack(_exactly(file, _HEAD.size))
        if size > RECORD_BOUND:
            raise _Broken
        return kind, size

    def _messages(self, file: BinaryIO, block: _Block) -> Iterator[tuple[int, int, int, int, bytes]]:
        """Yield channel, sequence number, times and data of each message of a block."""
        try:
            file.seek(block.offset)
            kind, size = self._head(file)
            if kind == MESSAGE:
                parts = [(kind, memoryview(_exactly(file, size)))]
            else:
                file.seek(block.offset)
                parts = list(_parts(self._unpacked(file)))
            for kind, body in parts:
                if kind == MESSAGE:
                    channel, sequence, log_ns, publish_ns = _MESSAGE.unpack_from(body)
                    yield channel, sequence, log_ns, publish_ns, bytes(body[_MESSAGE.size :])
        except (_Broken, struct.error, ValueError, OverflowError, OSError) as error:
            raise BagError(f"{self.path}: the chunk at byte {block.offset:,} is damaged {error}".rstrip()) from None

    def _unpacked(self, file: BinaryIO) -> bytes:
        """Read and decompress the chunk at the file's position."""
        kind, size = self._head(file)
        body = _exactly(file, size)
        if kind != CHUNK:
            raise _Broken
        *_, unpacked, check = _CHUNK.unpack_from(body)
        (length,) = struct.unpack_from("<I", body, _CHUNK.size)
        at = _CHUNK.size + 4
        method = body[at : at + length].decode("ascii", "replace")
        (packed,) = struct.unpack_from("<Q", body, at + length)
        data = memoryview(body)[at + length + 8 :]
        if unpacked > RECORD_BOUND or packed != len(data):
            raise _Broken
        try:
            found = bytes(data) if not method else compression.unpacked(method, data, unpacked)
        except compression.Damaged as error:
            raise _Broken(f"({error})") from None
        if len(found) != unpacked or (check and zlib.crc32(found) != check):
            raise _Broken("(its checksum does not match)")
        return found


def _record(waiting: _Waiting, channels: dict[int, Topic]) -> Record:
    log_ns, _, channel, sequence, publish_ns, data = waiting
    return Record(channels[channel], log_ns, publish_ns, sequence, data)


def _parts(data: bytes) -> Iterator[tuple[int, memoryview]]:
    """Yield opcode and body of each record of a decompressed chunk."""
    view, at, end = memoryview(data), 0, len(data)
    while at < end:
        kind, size = _HEAD.unpack_from(view, at)
        at += _HEAD.size
        if size > end - at:
            raise _Broken
        yield kind, view[at : at + size]
        at += size


def _exactly(file: BinaryIO, size: int) -> bytes:
    data = file.read(size)
    if len(data) != size:
        raise _Broken
    return data
