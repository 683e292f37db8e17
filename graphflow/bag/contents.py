"""The contents of a bag: topics, and serialized messages with their times."""

from __future__ import annotations

from typing import NamedTuple

from graphflow.qos import Qos


class Topic(NamedTuple):
    """A topic of a bag."""

    name: str
    type: str
    """`package/msg/Name`."""
    hash: str = ""
    """RIHS01; empty if the bag does not give it."""
    definition: str = ""
    """The definitions of the type and of its nested types, in ROS's form for bags; empty if the bag has none."""
    qos: tuple[Qos, ...] = ()
    """The QoS profiles that its publishers offered."""
    encoding: str = "cdr"


class Record(NamedTuple):
    """One serialized message of a bag."""

    topic: Topic
    log_ns: int
    """Time of reception, nanoseconds since 1970."""
    publish_ns: int
    """Time of sending."""
    sequence: int
    """The sequence number that its publisher gave it; 0 if not known."""
    data: bytes
    """CDR with its header of four bytes."""


class Contents(NamedTuple):
    """The contents of a bag or of one of its files."""

    topics: dict[str, Topic]
    counts: dict[str, int]
    """Number of messages by topic."""
    start_ns: int
    """Time of the first message; 0 if there is none."""
    end_ns: int
    """Time of the last message."""
    is_whole: bool = True
    """Whether the bag was closed properly."""

    @property
    def message_count(self) -> int:
        return sum(self.counts.values())


def together(parts: list[Contents]) -> Contents:
    """Return the contents of several files as one."""
    topics, counts = dict[str, Topic](), dict[str, int]()
    for part in parts:
        for name, topic in part.topics.items():
            topics.setdefault(name, topic)
            counts[name] = counts.get(name, 0) + part.counts.get(name, 0)
    filled = [part for part in parts if part.message_count]
    start, end = min((p.start_ns for p in filled), default=0), max((p.end_ns for p in filled), default=0)
    return Contents(topics, counts, start, end, all(part.is_whole for part in parts))
