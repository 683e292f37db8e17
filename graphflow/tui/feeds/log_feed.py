"""What all nodes have written: their log files, followed, in one bounded list in the order of time.

A record is known by its file and the offset at which it begins there, so that however often a console comes and goes,
it shows each record once.
"""

from __future__ import annotations

import re
from collections import Counter, deque
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import NamedTuple

RECORDS = 40_000
"""Records kept, of all nodes together."""
SERIOUS = 5_000
"""Warnings and errors kept, however many other records come after them."""
WARNING, ERROR = 2, 3
"""Indices of LEVELS."""
BACKLOG = 4 << 20
"""Bytes of each file that a console reads when it comes."""
AT_ONCE = 1 << 20
"""Bytes read of a file in one go."""
LINE_BOUND = 4_000
"""Characters kept of one line."""
LOGGERS = 1000
"""Loggers of one file whose nodes are remembered."""
RACE = "RACE: "
"""How the report of a lost update begins: see `deadlock.races`."""
LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")
_LINE = re.compile(r"\[(DEBUG|INFO|WARN|ERROR|FATAL)\] \[(\d{1,12}\.\d{1,9})\] \[([^\]]{1,300})\]: ?(.*)", re.DOTALL)
_ESCAPES = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)?|[\x00-\x08\x0b-\x1f\x7f-\x9f]")


class Record(NamedTuple):
    """One line of a log."""

    stamp: float
    """Seconds since 1970."""
    level: int
    """Index into LEVELS."""
    node: str
    text: str
    is_more: bool
    """Whether the line goes on with the record before it, as a traceback's lines do."""
    file: str
    offset: int
    times: int = 1
    """How often the line came in a row."""

    def repeats(self, other: Record) -> bool:
        """Whether this is the same line once more."""
        return not self.is_more and (self.text, self.node, self.level) == (other.text, other.node, other.level)


def plain_text(text: str) -> str:
    """A line without anything that a terminal would obey."""
    return _ESCAPES.sub("", text).expandtabs(4)


class LogFile:
    """One log file, read from where it was left.

    Args:
        nodes: The nodes that write it; the first is where lines without a name come from.
    """

    def __init__(self, path: Path, nodes: tuple[str, ...]) -> None:
        self.path = path
        self.skipped = 0
        """Bytes at the beginning that were not read."""
        self._offset = -1
        self._rest = b""
        self._nodes = nodes
        self._by_logger: dict[str, str] = {}
        self._last = Record(0.0, 1, nodes[0], "", False, path.name, 0)

    def read(self) -> list[Record]:
        """What is new, at most `AT_ONCE` bytes of it."""
        try:
            with self.path.open("rb") as file:
                size = file.seek(0, 2)
                if self._offset < 0:
                    self._offset = self._begin(size)
                    self.skipped = self._offset
                if size < self._offset:  # it was emptied
                    self._offset, self._rest = 0, b""
                if size == self._offset:
                    return []
                file.seek(self._offset)
                data = file.read(AT_ONCE)
        except OSError:
            return []
        begin = self._offset - len(self._rest)
        self._offset += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > 2 * AT_ONCE:  # a line without an end
            lines, self._rest = [*lines, self._rest], b""
        if begin == self.skipped and begin and lines:  # the first is the end of a line that was skipped
            begin += len(lines.pop(0)) + 1
            self.skipped = begin
        return list(self._records(lines, begin))

    def _begin(self, size: int) -> int:
        return max(0, size - BACKLOG)

    def _records(self, lines: list[bytes], offset: int) -> Iterator[Record]:
        name = self.path.name
        for raw in lines:
            text = raw[: 4 * LINE_BOUND].decode(errors="replace")[:LINE_BOUND]
            found = _LINE.match(text)
            if found is not None:
                word, stamp, logger, rest = found.groups()
                node = self._by_logger.get(logger) or self._node(logger)
                self._last = Record(float(stamp), LEVELS.index(word), node, plain_text(rest), False, name, offset)
                yield self._last
            elif text:
                last = self._last
                yield Record(last.stamp, last.level, last.node, plain_text(text), True, name, offset)
            offset += len(raw) + 1

    def _node(self, logger: str) -> str:
        """The node that a logger belongs to: `arm.hand` may be the node /arm/hand, or a logger of the node /arm."""
        name = "/" + logger.replace(".", "/")
        above = [n for n in self._nodes if name == n or name.startswith(f"{n}/")]
        node = max(above, key=len, default=self._nodes[0])
        if len(self._by_logger) < LOGGERS:
            self._by_logger[logger] = node
        return node


class Logs:
    """The records of all nodes, oldest first."""

    def __init__(self, bound: int = RECORDS) -> None:
        self.records: deque[Record] = deque(maxlen=bound)
        self.total = 0
        """Records ever added; the newest has this number less one."""
        self.serious: deque[Record] = deque(maxlen=SERIOUS)
        """The warnings and errors among them, and those that had to go since."""
        self.counts: Counter[str] = Counter()
        """Records by node."""
        self.warnings: Counter[str] = Counter()
        self.errors: Counter[str] = Counter()
        """By node; a traceback's lines count as one."""
        self.last_error: dict[str, Record] = {}
        """By node, the newest last."""
        self.races: list[list[Record]] = []
        """The reports of lost updates, line by line; a race is reported once."""
        self._report: dict[str, list[Record]] = {}
        """By node, the one of these that is being read."""
        self._files: dict[Path, LogFile] = {}

    def follow(self, files: Iterable[tuple[str, tuple[str, ...]]]) -> None:
        """Read these files too: pairs of path and the nodes that write there."""
        for path, nodes in files:
            if Path(path) not in self._files:
                self._files[Path(path)] = LogFile(Path(path), nodes)

    def read(self) -> int:
        """Take in what was written meanwhile; returns how many records."""
        fresh = [record for file in self._files.values() for record in file.read()]
        if len(self._files) > 1 and fresh:
            fresh.sort(key=lambda record: record.stamp)
        self.add(fresh)
        return len(fresh)

    def add(self, fresh: list[Record]) -> None:
        """Take in records from elsewhere."""
        for record in fresh:
            self.counts[record.node] += 1
            if record.level >= WARNING:
                self._note(record)
        self.records.extend(fresh)
        self.total += len(fresh)

    def _note(self, record: Record) -> None:
        """Keep a warning or an error."""
        self.serious.append(record)
        if record.is_more:
            self._report.get(record.node, []).append(record)
            return
        self._report.pop(record.node, None)
        if record.level == WARNING:
            self.warnings[record.node] += 1
            if record.text.startswith(RACE):
                self._report[record.node] = [record]
                self.races.append(self._report[record.node])
            return
        self.errors[record.node] += 1
        self.last_error.pop(record.node, None)
        self.last_error[record.node] = record

    @property
    def lost(self) -> int:
        """Records that are not kept any more."""
        return self.total - len(self.records)

    def since(self, number: int) -> Iterator[Record]:
        """The records from a number on, as far as they are still there."""
        first = self.total - len(self.records)
        start = max(0, number - first)
        return islice(self.records, start, None)
