"""The messages of a bag as objects. Types that are not installed are made from what the bag says of them."""

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
    """When it was received, nanoseconds since 1970."""

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
"""Other words for its parts, as people try them."""


def read(
    path: Path | str,
    topics: Collection[str] | str | None = None,
    *,
    start_ns: int = 0,
    end_ns: int | None = None,
) -> Iterator[BagMessage]:
    """The messages of a bag, in the order of their times.

    Args:
        path: The bag: a folder, or a file: MCAP, `.db3` or ROS 1's `.bag`.
        topics: Those that are wanted, or one of them; None for all.
        start_ns: From this time on, nanoseconds since 1970.
        end_ns: Up to this time, which does not belong to it.

    Raises:
        BagError: The bag cannot be read, has no such topic, or has a type that is not known and not defined in it.
        DecodeError: A message is not of its type.
    """
    bag = Bag(path)
    if topics is None:
        return said(bag.records(None, start_ns, end_ns))
    named = frozenset(expand(name, "/", "bag") for name in ([topics] if isinstance(topics, str) else topics))
    if absent := remarks([bag], Choice(topics=named)):
        raise BagError(f"{path}: {'; '.join(absent)}")
    return said(bag.records(named, start_ns, end_ns))


def decoder(topic: Topic) -> Callable[[bytes], Any]:
    """What makes messages of a topic's records.

    Raises:
        BagError: Its type is not known, and not defined in the bag, or it is not serialized as CDR.
    """
    if topic.encoding != "cdr":
        raise BagError(f"{topic.name}: its messages are serialized as {topic.encoding!r}, not as CDR")
    learn(topic)
    return registry.codec(topic.type).decode


def learn(topic: Topic) -> None:
    """Make a topic's type known, from its definition in the bag, if it is not known here.

    Raises:
        BagError: There is no definition that can be used, or another is known here.
    """
    try:
        is_whole = len(topic.type.split("/")) == 3  # else it is said how types are called
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


def said(records: Iterator[Record]) -> Iterator[BagMessage]:
    """Records as messages."""
    decoders: dict[str, Callable[[bytes], Any]] = {}
    for record in records:
        decode = decoders.get(record.topic.name)
        if decode is None:
            decode = decoders[record.topic.name] = decoder(record.topic)
        yield BagMessage(record.topic.name, decode(record.data), record.log_ns)
