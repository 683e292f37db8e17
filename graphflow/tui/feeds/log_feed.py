"""The log files of all nodes, followed and merged by time into one bounded list.

A record is identified by its file and offset, so that it is shown once however often consoles attach and detach.
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
"""Warnings and errors kept, however many other records follow them."""
WARNING, ERROR = 2, 3
"""Indices of LEVELS."""
BACKLOG = 4 << 20
"""Bytes read from the end of each file when a console attaches."""
AT_ONCE = 1 << 20
"""Maximum bytes of one read."""
LINE_BOUND = 4_000
"""Maximum characters of a line; the rest is dropped."""
LOGGERS = 1000
"""Loggers per file whose nodes are remembered."""
RACE = "RACE: "
"""The beginning of a lost update's report: see `deadlock.races`."""
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
    """Whether the line continues the record before it, as those of a traceback do."""
    file: str
    offset: int
    times: int = 1
    """Number of consecutive occurrences."""

    def repeats(self, other: Record) -> bool:
        """Return whether a record repeats this one."""
        return not self.is_more and (self.text, self.node, self.level) == (other.text, other.node, other.level)


def plain_text(text: str) -> str:
    """Remove the control characters and escape sequences that a terminal would interpret."""
    return _ESCAPES.sub("", text).expandtabs(4)


class LogFile:
    """One log file, read incrementally.

    Args:
        nodes: The nodes that write it; lines without a logger belong to the first.
    """

    def __init__(self, path: Path, nodes: tuple[str, ...]) -> None:
        self.path = path
        self.skipped = 0
        """Bytes at the beginning that were skipped."""
        self._offset = -1
        self._rest = b""
        self._nodes = nodes
        self._by_logger: dict[str, str] = {}
        self._last = Record(0.0, 1, nodes[0], "", False, path.name, 0)

    def read(self) -> list[Record]:
        """Read new records, from at most `AT_ONCE` bytes."""
        try:
            with self.path.open("rb") as file:
                size = file.seek(0, 2)
                if self._offset < 0:
                    self._offset = self._begin(size)
                    self.skipped = self._offset
                if size < self._offset:  # the file was truncated
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
        if len(self._rest) > 2 * AT_ONCE:  # a line without an end: do not buffer it any longer
            lines, self._rest = [*lines, self._rest], b""
        if begin == self.skipped and begin and lines:  # after a skip, the first line is incomplete
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
        """Return the node of a logger: `arm.hand` may be the node /arm/hand, or a logger of the node /arm."""
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
        """Records ever added; the index of the newest is one less."""
        self.serious: deque[Record] = deque(maxlen=SERIOUS)
        """Warnings and errors, including those that are no longer in `records`."""
        self.counts: Counter[str] = Counter()
        """Number of records by node."""
        self.warnings: Counter[str] = Counter()
        self.errors: Counter[str] = Counter()
        """Number of errors by node; a traceback counts once."""
        self.last_error: dict[str, Record] = {}
        """The last error by node, newest last."""
        self.races: list[list[Record]] = []
        """The reports of lost updates as lists of lines; each race is reported once."""
        self._report: dict[str, list[Record]] = {}
        """The unfinished report by node."""
        self._files: dict[Path, LogFile] = {}

    def follow(self, files: Iterable[tuple[str, tuple[str, ...]]]) -> None:
        """Follow more files: pairs of a path and the nodes that write to it."""
        for path, nodes in files:
            if Path(path) not in self._files:
                self._files[Path(path)] = LogFile(Path(path), nodes)

    def read(self) -> int:
        """Read new records from all files; return their number."""
        fresh = [record for file in self._files.values() for record in file.read()]
        if len(self._files) > 1 and fresh:
            # A stable sort: the lines of a traceback have the stamp of its first line, and stay behind it.
            fresh.sort(key=lambda record: record.stamp)
        self.add(fresh)
        return len(fresh)

    def add(self, fresh: list[Record]) -> None:
        """Add records from another source."""
        for record in fresh:
            self.counts[record.node] += 1
            if record.level >= WARNING:
                self._remember(record)
        self.records.extend(fresh)
        self.total += len(fresh)

    def _remember(self, record: Record) -> None:
        """Remember a warning or an error."""
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
        # Taken out first, so that it becomes the last of the dict.
        self.last_error.pop(record.node, None)
        self.last_error[record.node] = record

    @property
    def lost(self) -> int:
        """Number of records that are no longer kept."""
        return self.total - len(self.records)

    def since(self, number: int) -> Iterator[Record]:
        """Return the records from an index on, as far as they are still kept."""
        first = self.total - len(self.records)
        start = max(0, number - first)
        return islice(self.records, start, None)
