"""The messages of a bag as objects; types that are not installed are built from the definitions in the bag."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from graphflow.bag.contents import Record, Topic
from graphflow.bag.formats.definitions import parted
from graphflow.bag.missing import remarks
from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import Choice
from graphflow.errors import BagError, InterfaceError, UnknownInterface
from graphflow.msgs import registry
from graphflow.names import expand


class BagMessage(NamedTuple):
    """One message of a bag."""

    topic: str
    message: Any
    time_ns: int
    """Time of reception, nanoseconds since 1970."""

    def __getattr__(self, name: str) -> Any:
        text = f"'BagMessage' object has no attribute {name!r}"
        if name in _MEANT:
            text += f"; did you mean .{_MEANT[name]}?"
        elif not name.startswith("_") and hasattr(self.message, name):
            text += f"; it is a field of its message: write .message.{name}"
        raise AttributeError(text)


_MEANT = {
    **dict.fromkeys(("msg", "data"), "message"),
    **dict.fromkeys(("time", "timestamp", "stamp", "t"), "time_ns"),
    **dict.fromkeys(("topic_name", "name", "channel"), "topic"),
}
"""Other names for its fields that users try."""


def read(
    path: Path | str,
    topics: Collection[str] | str | None = None,
    *,
    start_ns: int = 0,
    end_ns: int | None = None,
) -> Iterator[BagMessage]:
    """Read the messages of a bag, in the order of their times.

    Args:
        path: The bag: a folder, or a file: MCAP, `.db3` or ROS 1's `.bag`.
        topics: The topics to read, or one of them; None for all.
        start_ns: Earliest time, nanoseconds since 1970.
        end_ns: Time before which messages are read.

    Raises:
        BagError: The bag cannot be read, has no such topic, or has a type that is neither known nor defined in it.
        DecodeError: A message is not of its type.
    """
    bag = Bag(path)
    if topics is None:
        return messages(bag.records(None, start_ns, end_ns))
    named = frozenset(expand(name, "/", "bag") for name in ([topics] if isinstance(topics, str) else topics))
    if absent := remarks([bag], Choice(topics=named)):
        raise BagError(f"{path}: {'; '.join(absent)}")
    return messages(bag.records(named, start_ns, end_ns))


def decoder(topic: Topic) -> Callable[[bytes], Any]:
    """Return the function that decodes the records of a topic.

    Raises:
        BagError: Its type is neither known nor defined in the bag, or it is not serialized as CDR.
    """
    if topic.encoding != "cdr":
        raise BagError(f"{topic.name}: its messages are serialized as {topic.encoding!r}, not as CDR")
    learn(topic)
    return registry.codec(topic.type).decode


def learn(topic: Topic) -> None:
    """Register a topic's type from its definition in the bag, unless it is known.

    Raises:
        BagError: The definition is missing or unusable, or contradicts a known one.
    """
    try:
        is_whole = len(topic.type.split("/")) == 3  # otherwise the error explains the form of type names
        found = registry.hash_of(topic.type if is_whole else registry.full_name(topic.type))
    except UnknownInterface as unknown:
        if not topic.definition:
            raise BagError(f"{topic.name}: {unknown}; the bag has no definition of it") from None
        try:
            registry.adopt(topic.type, topic.hash, parted(topic.type, topic.definition))
            return
        except InterfaceError as error:
            raise BagError(f"{topic.name}: the bag's definition cannot be used: {error}") from None
    if topic.hash and found != topic.hash:
        raise BagError(f"{topic.name}: it was recorded with another definition of {topic.type} than the one here")


def messages(records: Iterator[Record]) -> Iterator[BagMessage]:
    """Records as messages."""
    decoders: dict[str, Callable[[bytes], Any]] = {}
    for record in records:
        decode = decoders.get(record.topic.name)
        if decode is None:
            decode = decoders[record.topic.name] = decoder(record.topic)
        yield BagMessage(record.topic.name, decode(record.data), record.log_ns)
