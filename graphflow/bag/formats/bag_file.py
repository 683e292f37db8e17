"""One file of a bag as it is being written, whatever its format."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path

from graphflow.bag.contents import Contents, Record, Topic


class Part(ABC):
    """Counts what is written; a format says how."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._numbers: dict[str, int] = {}
        """Of topics in the file."""
        self.topics: dict[str, Topic] = {}
        self.counts: dict[str, int] = {}
        self.start_ns = self.end_ns = 0
        self.written = 0
        """Bytes of messages."""

    @property
    def contents(self) -> Contents:
        return Contents(dict(self.topics), dict(self.counts), self.start_ns, self.end_ns)

    @property
    @abstractmethod
    def size(self) -> int:
        """Bytes of the file so far."""

    def declare(self, topic: Topic) -> int:
        """The number of a topic in the file."""
        number = self._numbers.get(topic.name)
        if number is None:
            number = self._numbers[topic.name] = self._declare(topic)
            self.topics[topic.name], self.counts[topic.name] = topic, 0
        return number

    def add(self, record: Record) -> None:
        """Write a message; it may wait for `flush`."""
        name = record.topic.name
        self._add(self.declare(record.topic), record)
        self.start_ns = min(self.start_ns or record.log_ns, record.log_ns)
        self.end_ns = max(self.end_ns, record.log_ns)
        self.counts[name] += 1
        self.written += len(record.data)

    @abstractmethod
    def check(self) -> None:
        """Raise the error of a disk that has become full, once what it concerned is written."""

    @abstractmethod
    def flush(self) -> None:
        """Put what has been written into the file."""

    @abstractmethod
    def sync(self) -> None:
        """Put what is in the file on the disk."""

    @abstractmethod
    def finish(self, said: str) -> None:
        """Close the file properly.

        Args:
            said: The bag's metadata as far as it concerns this file.
        """

    @abstractmethod
    def abandon(self) -> None:
        """Close the file as it is."""

    @abstractmethod
    def _declare(self, topic: Topic) -> int:
        """Write a topic that is new to the file; returns its number there."""

    @abstractmethod
    def _add(self, number: int, record: Record) -> None:
        """Write a message of a topic by its number."""
