"""Repeated messages: the last ones of some topics begin every file and every snapshot.

Source: rosbag2, `--repeat-transient-local` and `--repeat-all-transient-local`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from graphflow.bag.contents import Record, Topic
from graphflow.qos import Durability


@dataclass(frozen=True)
class Repeats:
    """The number of repeated messages by topic."""

    topics: Mapping[str, int] = field(default_factory=dict)
    """Numbers by full name of the topic."""
    latched: int = 0
    """The number for every other topic that a publisher offers as transient local."""

    def count(self, topic: Topic) -> int:
        """Return the number of messages to repeat for a topic."""
        if topic.name in self.topics:
            return self.topics[topic.name]
        return self.latched if any(qos.durability is Durability.TRANSIENT_LOCAL for qos in topic.qos) else 0


NO_REPEATS = Repeats()


class LatchedMessages:
    """The last messages of the repeated topics."""

    def __init__(self, repeats: Repeats) -> None:
        self._repeats = repeats
        self._last: dict[str, deque[Record]] = {}

    def put(self, record: Record) -> None:
        """Store a message, if its topic is repeated."""
        last = self._last.get(record.topic.name)
        if last is None:
            last = self._last[record.topic.name] = deque(maxlen=self._repeats.count(record.topic))
        last.append(record)

    def before(self, first_ns: int, following: Iterable[Record] = ()) -> Iterator[Record]:
        """Return the messages to write before others, with the time of the first of them.

        Args:
            first_ns: Time of the first of the others.
            following: The others; they count towards the numbers, too.
        """
        missing = {name: last.maxlen or 0 for name, last in self._last.items()}
        for record in following:
            if record.topic.name in missing:
                missing[record.topic.name] -= 1
        for name, last in self._last.items():
            for record in list(last)[-missing[name] :] if missing[name] > 0 else ():
                yield record._replace(log_ns=first_ns)
