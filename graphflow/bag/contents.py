"""What is in a bag: topics, and serialized messages with their times."""

from __future__ import annotations

from typing import NamedTuple

from graphflow.qos import Qos


class Topic(NamedTuple):
    """A topic as a bag has it."""

    name: str
    type: str
    """`package/msg/Name`."""
    hash: str = ""
    """RIHS01, empty if the bag does not say."""
    definition: str = ""
    """The type's definition and those of the types in it, in ROS's form for bags; empty if the bag has none."""
    qos: tuple[Qos, ...] = ()
    """What its publishers offered."""
    encoding: str = "cdr"


class Record(NamedTuple):
    """One message of a bag."""

    topic: Topic
    log_ns: int
    """When it was received, nanoseconds since 1970."""
    publish_ns: int
    """When it was sent."""
    sequence: int
    """Its number among those of its publisher, 0 if not known."""
    data: bytes
    """CDR, with its header of four bytes."""


class Contents(NamedTuple):
    """What a bag, or one of its files, has in it."""

    topics: dict[str, Topic]
    counts: dict[str, int]
    """Messages by topic."""
    start_ns: int
    """Time of the first message; 0 if there is none."""
    end_ns: int
    """Time of the last."""
    is_whole: bool = True
    """Whether it was closed properly."""

    @property
    def message_count(self) -> int:
        return sum(self.counts.values())


def together(parts: list[Contents]) -> Contents:
    """The contents of several files as one."""
    topics, counts = dict[str, Topic](), dict[str, int]()
    for part in parts:
        for name, topic in part.topics.items():
            topics.setdefault(name, topic)
            counts[name] = counts.get(name, 0) + part.counts.get(name, 0)
    filled = [part for part in parts if part.message_count]
    start, end = min((p.start_ns for p in filled), default=0), max((p.end_ns for p in filled), default=0)
    return Contents(topics, counts, start, end, all(part.is_whole for part in parts))
