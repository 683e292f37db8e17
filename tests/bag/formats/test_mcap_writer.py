"""MCAP files as they are written, judged by mcap's own readers."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import pytest
from mcap.reader import SeekingReader
from mcap.records import Channel, Chunk, Message, MessageIndex, Schema
from mcap.stream_reader import StreamReader

from graphflow.bag.formats.mcap_writer import McapWriter

Said = tuple[int, int, bytes, int, int]
"""Channel, times, data and number of a message."""


def written(messages: list[Said], compression: str = "", chunk_size: int = 1000) -> bytes:
    stream = BytesIO()
    writer = McapWriter(stream, "test", chunk_size=chunk_size, compression=compression)
    schema = writer.register_schema("a/msg/B", "ros2msg", b"string data\n")
    for number in range(3):
        writer.register_channel(f"/t{number}", "cdr", schema, {"some": "thing"})
    for channel, log_ns, data, publish_ns, sequence in messages:
        writer.add_message(channel, log_ns, data, publish_ns, sequence)
    writer.flush()
    writer.add_metadata("said", {"a": "b"})
    writer.finish()
    return stream.getvalue()


def some(sizes: list[int]) -> list[Said]:
    return [
        (1 + n % 2, 9000 - n * 10 if n % 3 else 9000 + n, bytes([n % 256]) * size, n, n) for n, size in enumerate(sizes)
    ]


CASES = {
    "none": [],
    "one": some([0]),
    "small": some([7] * 500),
    "of the size of a chunk": some([1000 - 31, 1000 - 30, 1001] * 3),
    "larger than a chunk": some([5, 100_000, 5, 2000, 0, 5]),
}


@pytest.mark.parametrize("compression", ["", "zstd", "lz4"])
@pytest.mark.parametrize("messages", CASES.values(), ids=CASES)
def test_mcap_reads_it(messages: list[Said], compression: str) -> None:
    """By the index and record by record, all checksums right."""
    data = written(messages, compression)
    reader = SeekingReader(BytesIO(data), validate_crcs=True)
    found = [(c.id, m.log_time, m.data, m.publish_time, m.sequence) for _, c, m in reader.iter_messages()]
    assert found == sorted(messages, key=lambda m: m[1])
    summary: Any = reader.get_summary()
    assert [c.topic for c in summary.channels.values()] == ["/t0", "/t1", "/t2"]
    assert (summary.statistics.message_count, summary.statistics.chunk_count) == (
        len(messages),
        len(summary.chunk_indexes),
    )
    times = [m[1] for m in messages] or [0]
    assert (summary.statistics.message_start_time, summary.statistics.message_end_time) == (min(times), max(times))
    assert [(m.name, m.metadata) for m in reader.iter_metadata()] == [("said", {"a": "b"})]
    records = list(StreamReader(BytesIO(data), validate_crcs=True).records)
    assert [(m.channel_id, m.log_time, m.data) for m in records if isinstance(m, Message)] == [m[:3] for m in messages]


def test_indexes_of_messages() -> None:
    """Each entry is the place of a message of its channel in the chunk; schemas and channels come before messages."""
    messages = CASES["small"]
    data = written(messages)
    records = list(StreamReader(BytesIO(data), emit_chunks=True).records)
    count = 0
    chunk: Chunk
    for record in records:
        if isinstance(record, Chunk):
            chunk = record
        elif isinstance(record, MessageIndex):
            for log_ns, at in record.records:
                head = chunk.data[at : at + 31]
                assert (head[0], int.from_bytes(head[9:11], "little")) == (5, record.channel_id)
                assert int.from_bytes(head[15:23], "little") == log_ns
                count += 1
    assert count == len(messages)
    kinds = [type(r) for r in StreamReader(BytesIO(data)).records]
    assert kinds.index(Schema) < kinds.index(Channel) < kinds.index(Message)
