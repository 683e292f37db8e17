"""The writer of MCAP files: messages are copied once, into a reused chunk, and compressed for speed.

mcap's own writer copies a message four times and compresses with Zstandard's level 3, which took most of a recorder's
time; level 1, that of rosbag2's preset `zstd_fast`, is four times as fast and compresses noise as well.

Source: the MCAP specification, "Records"; the rare ones are written by mcap's own classes.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

MAGIC = b"\x89MCAP0\r\n"
LEVEL = 1
"""Level of Zstandard."""
_HEAD = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<BQHIQQ")
_ENTRY = struct.Struct("<QQ")
_INDEX = struct.Struct("<BQHI")


class Stream(Protocol):
    """The target of a writer: each write is all or nothing."""

    def write(self, data: bytes | memoryview) -> int: ...

    def tell(self) -> int: ...


class McapWriter:
    """A file during writing.

    Args:
        chunk_size: Size in bytes of messages after which a chunk ends.
        compression: `zstd`, `lz4`, or nothing.
    """

    def __init__(self, stream: Stream, library: str, *, chunk_size: int, compression: str = "") -> None:
        self._stream, self._chunk_size, self._compression = stream, chunk_size, compression
        self._compress = _compressor(compression)
        self._head = struct.Struct(f"<BQQQQII{len(compression)}sQ")
        """The header of a chunk's record."""
        self._chunk = self._room()
        """The chunk's header with its records."""
        self._end = self._head.size
        """Offset of the next record in the chunk."""
        self._index: dict[int, list[tuple[int, int]]] = {}
        """Times and offsets of the chunk's messages, by channel."""
        self._start_ns = self._end_ns = 0
        self._schemas: list[Schema] = []
        self._channels: list[Channel] = []
        self._chunks: list[ChunkIndex] = []
        self._metadata: list[MetadataIndex] = []
        self._counts: dict[int, int] = {}
        self._stream.write(MAGIC + _record(Header("ros2", library)))

    def register_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Write a schema; returns its number."""
        self._schemas.append(Schema(id=len(self._schemas) + 1, data=data, encoding=encoding, name=name))
        self._put(_record(self._schemas[-1]))
        return self._schemas[-1].id

    def register_channel(self, topic: str, encoding: str, schema: int, about: Mapping[str, str]) -> int:
        """Write a channel; returns its number."""
        number = len(self._channels) + 1
        channel = Channel(id=number, topic=topic, message_encoding=encoding, schema_id=schema, metadata=dict(about))
        self._channels.append(channel)
        self._counts[number] = 0
        self._put(_record(channel))
        return number

    def add_message(self, channel: int, log_ns: int, data: bytes, publish_ns: int, sequence: int) -> None:
        """Write a message into the chunk, and a full chunk into the file."""
        at, length = self._end, len(data)
        end = at + _MESSAGE.size + length
        if end > len(self._chunk):
            self._chunk.extend(bytes(end - len(self._chunk)))
        _MESSAGE.pack_into(
            self._chunk, at, Opcode.MESSAGE, length + _MESSAGE.size - _HEAD.size, channel, sequence, log_ns, publish_ns
        )
        self._chunk[end - length : end] = data
        self._end = end
        if not self._index:
            self._start_ns = self._end_ns = log_ns
        elif log_ns < self._start_ns:
            self._start_ns = log_ns
        elif log_ns > self._end_ns:
            self._end_ns = log_ns
        self._index.setdefault(channel, []).append((log_ns, at - self._head.size))
        if end > self._chunk_size:
            self.flush()

    def add_metadata(self, name: str, about: Mapping[str, str]) -> None:
        """Write a metadata record."""
        data = _record(Metadata(name=name, metadata=dict(about)))
        self._metadata.append(MetadataIndex(offset=self._stream.tell(), length=len(data), name=name))
        self._stream.write(data)

    def flush(self) -> None:
        """Write the chunk to the file, if it has messages."""
        if not self._index:
            return
        index, self._index, end, self._end = self._index, {}, self._end, self._head.size
        offset, size = self._stream.tell(), end - self._head.size
        with memoryview(self._chunk) as whole, whole[self._head.size : end] as raw:
            packed = self._compress(raw) if self._compress is not None else raw
            length = self._head.size - _HEAD.size + len(packed)
            head = Opcode.CHUNK, length, self._start_ns, self._end_ns, size, zlib.crc32(raw)
            form = self._compression.encode()
            self._head.pack_into(whole, 0, *head, len(form), form, len(packed))
            with whole[: self._head.size] as begin, whole[:end] as record:
                self._stream.write(record if packed is raw else b"".join((begin, packed)))
        if len(self._chunk) > 2 * self._chunk_size:  # one large message must not keep its buffer for ever
            self._chunk = self._room()
        start = self._stream.tell()
        offsets, tables, at = dict[int, int](), [], start
        for channel, entries in index.items():
            self._counts[channel] += len(entries)
            offsets[channel] = at
            length = len(entries) * _ENTRY.size
            tables.append(_INDEX.pack(Opcode.MESSAGE_INDEX, _INDEX.size - _HEAD.size + length, channel, length))
            tables.append(b"".join(_ENTRY.pack(*entry) for entry in entries))
            at += _INDEX.size + length
        self._chunks.append(
            ChunkIndex(
                chunk_length=start - offset,
                chunk_start_offset=offset,
                compression=self._compression,
                compressed_size=start - offset - self._head.size,
                message_end_time=self._end_ns,
                message_index_length=at - start,
                message_index_offsets=offsets,
                message_start_time=self._start_ns,
                uncompressed_size=size,
            )
        )
        self._stream.write(b"".join(tables))

    def finish(self) -> None:
        """Write the end of the file: its index."""
        self.flush()
        # 0 means that there is no checksum (MCAP, "Data End").
        self._stream.write(_record(DataEnd(data_section_crc=0)))
        start = self._stream.tell()
        groups: list[tuple[Opcode, list[McapRecord]]] = [
            (Opcode.SCHEMA, [*self._schemas]),
            (Opcode.CHANNEL, [*self._channels]),
            (Opcode.STATISTICS, [self._statistics()]),
            (Opcode.CHUNK_INDEX, [*self._chunks]),
            (Opcode.METADATA_INDEX, [*self._metadata]),
        ]
        summary, offsets = bytearray(), list[McapRecord]()
        for kind, records in groups:
            at = len(summary)
            for record in records:
                summary += _record(record)
            if records:
                offsets.append(SummaryOffset(group_opcode=kind, group_start=start + at, group_length=len(summary) - at))
        offsets_start = start + len(summary)
        for record in offsets:
            summary += _record(record)
        # The checksum covers the summary, and the footer up to the checksum itself (MCAP, "Footer").
        footer = struct.pack("<BQQQ", Opcode.FOOTER, 20, start, offsets_start)
        check = zlib.crc32(footer, zlib.crc32(summary))
        end = Footer(summary_start=start, summary_offset_start=offsets_start, summary_crc=check)
        self._stream.write(bytes(summary) + _record(end) + MAGIC)

    def _statistics(self) -> Statistics:
        return Statistics(
            attachment_count=0,
            channel_count=len(self._channels),
            channel_message_counts={number: count for number, count in self._counts.items() if count},
            chunk_count=len(self._chunks),
            message_count=sum(self._counts.values()),
            message_end_time=max((chunk.message_end_time for chunk in self._chunks), default=0),
            message_start_time=min((chunk.message_start_time for chunk in self._chunks), default=0),
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )

    def _put(self, data: bytes) -> None:
        """Append a record to the chunk."""
        end = self._end + len(data)
        if end > len(self._chunk):
            self._chunk.extend(bytes(end - len(self._chunk)))
        self._chunk[self._end : end] = data
        self._end = end

    def _room(self) -> bytearray:
        return bytearray(self._head.size + self._chunk_size + (self._chunk_size >> 2))


def _record(record: McapRecord) -> bytes:
    builder: Any = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())


def _compressor(form: str) -> Callable[[memoryview], bytes] | None:
    if form == "zstd":
        import zstandard

        return zstandard.ZstdCompressor(level=LEVEL).compress
    if form == "lz4":
        import lz4.frame

        return lambda data: bytes(lz4.frame.compress(data))
    return None
