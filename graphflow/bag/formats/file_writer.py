"""A file of a bag during writing, of any format."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path

from graphflow.bag.contents import Contents, Record, Topic


class FileWriter(ABC):
    """The counts of a file; subclasses write their format."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._numbers: dict[str, int] = {}
        """The numbers of topics in the file."""
        self.topics: dict[str, Topic] = {}
        self.counts: dict[str, int] = {}
        self.start_ns = self.end_ns = 0
        self.written = 0
        """Size of the messages in bytes."""

    @property
    def contents(self) -> Contents:
        return Contents(dict(self.topics), dict(self.counts), self.start_ns, self.end_ns)

    @property
    @abstractmethod
    def size(self) -> int:
        """The size of the file so far in bytes."""

    def declare(self, topic: Topic) -> int:
        """Return the number of a topic in the file, which is added if it is new."""
        number = self._numbers.get(topic.name)
        if number is None:
            number = self._numbers[topic.name] = self._declare(topic)
            self.topics[topic.name], self.counts[topic.name] = topic, 0
        return number

    def add(self, record: Record) -> None:
        """Write a message; it may be buffered until `flush`."""
        name = record.topic.name
        self._add(self.declare(record.topic), record)
        self.start_ns = min(self.start_ns or record.log_ns, record.log_ns)
        self.end_ns = max(self.end_ns, record.log_ns)
        self.counts[name] += 1
        self.written += len(record.data)

    @abstractmethod
    def check(self) -> None:
        """Raise the error of a full disk, once the data concerned are written."""

    @abstractmethod
    def flush(self) -> None:
        """Write buffered data into the file."""

    @abstractmethod
    def sync(self) -> None:
        """Write the file's data to the disk."""

    @abstractmethod
    def finish(self, text: str) -> None:
        """Close the file properly.

        Args:
            text: The bag's metadata as far as it concerns this file.
        """

    @abstractmethod
    def abandon(self) -> None:
        """Close the file as it is."""

    @abstractmethod
    def _declare(self, topic: Topic) -> int:
        """Write a new topic; returns its number in the file."""

    @abstractmethod
    def _add(self, number: int, record: Record) -> None:
        """Write a message of a topic, by the topic's number."""
