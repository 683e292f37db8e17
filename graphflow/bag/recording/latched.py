"""The last messages of topics that are repeated at the beginning of every file and of every snapshot.

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
    """How many messages of which topics are repeated."""

    topics: Mapping[str, int] = field(default_factory=dict)
    """Numbers by full name."""
    latched: int = 0
    """Of each other topic that a publisher offers with transient-local durability."""

    def count(self, topic: Topic) -> int:
        """How many messages of a topic."""
        if topic.name in self.topics:
            return self.topics[topic.name]
        return self.latched if any(qos.durability is Durability.TRANSIENT_LOCAL for qos in topic.qos) else 0


NO_REPEATS = Repeats()


class LatchedMessages:
    """Keeps the last messages of such topics."""

    def __init__(self, repeats: Repeats) -> None:
        self._repeats = repeats
        self._last: dict[str, deque[Record]] = {}

    def put(self, record: Record) -> None:
        """Keep a message, if it is of such a topic."""
        last = self._last.get(record.topic.name)
        if last is None:
            last = self._last[record.topic.name] = deque(maxlen=self._repeats.count(record.topic))
        last.append(record)

    def before(self, first_ns: int, following: Iterable[Record] = ()) -> Iterator[Record]:
        """The messages to write before others, as if they had come with the first of them.

        Args:
            first_ns: When the first of the others came.
            following: The others; those of such topics among them count, too.
        """
        missing = {name: last.maxlen or 0 for name, last in self._last.items()}
        for record in following:
            if record.topic.name in missing:
                missing[record.topic.name] -= 1
        for name, last in self._last.items():
            for record in list(last)[-missing[name] :] if missing[name] > 0 else ():
                yield record._replace(log_ns=first_ns)
