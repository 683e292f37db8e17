"""Parts of bags count what is written, whatever their format."""

from __future__ import annotations

from pathlib import Path

from graphflow.bag.contents import Record, Topic
from graphflow.bag.formats.file_writer import FileWriter
from tests.bag.cast import CHATTER, COUNT, MAP, START, some_records


class Listed(FileWriter):
    """Keeps what it is told to write."""

    def __init__(self) -> None:
        super().__init__(Path("listed"))
        self.declared: list[str] = []
        self.added: list[tuple[int, Record]] = []

    @property
    def size(self) -> int:
        return 0

    def check(self) -> None:
        """Its disk has room."""

    def flush(self) -> None:
        """Nothing waits."""

    def sync(self) -> None:
        """There is no disk."""

    def finish(self, said: str) -> None:
        """There is no file."""

    def abandon(self) -> None:
        """There is no file."""

    def _declare(self, topic: Topic) -> int:
        self.declared.append(topic.name)
        return len(self.declared)

    def _add(self, number: int, record: Record) -> None:
        self.added.append((number, record))


def test_what_is_counted() -> None:
    """Topics once, also those without messages; messages, their bytes, and the first and last time, in any order."""
    part, records = Listed(), [one for one in reversed(some_records()) if one.topic != CHATTER]
    part.declare(CHATTER)
    for one in records:
        part.add(one)
    assert part.declared == ["/chatter", "/count", "/map"]
    assert [number for number, _ in part.added] == [2] * 20 + [3]
    contents = part.contents
    assert contents.topics == {"/chatter": CHATTER, "/count": COUNT, "/map": MAP}
    assert contents.counts == {"/chatter": 0, "/count": 20, "/map": 1}
    assert (contents.start_ns, contents.end_ns) == (START, START + 1_950_000_000)
    assert part.written == sum(len(one.data) for one in records)
