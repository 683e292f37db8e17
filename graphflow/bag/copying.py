"""Copying bags: recover, cut, filter, merge or compress them."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from graphflow.bag.contents import Contents, Topic
from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import Choice
from graphflow.bag.writer import BagWriter
from graphflow.errors import BagError

TOLD_EVERY = 100
"""Number of messages between two reports of progress."""


def joined(bags: Sequence[Bag], choice: Choice, remaps: Mapping[str, str]) -> dict[str, Topic]:
    """Return the topics to copy, by their names in the bags; those of one new name become one.

    Args:
        bags: The sources.
        choice: The topics to copy.
        remaps: New names by names in the bags.

    Raises:
        BagError: Two bags have different types, or different definitions of a type, on a topic.
    """
    names: dict[str, str] = {}
    found: dict[str, Topic] = {}
    for bag in bags:
        for name, topic in bag.contents.topics.items():
            if not choice.wants(name, topic.type):
                continue
            new = topic._replace(name=remaps.get(name, name))
            known = found.setdefault(new.name, new)
            # Older distributions write no hash.
            is_other = known.hash != new.hash and bool(known.hash and new.hash)
            if is_other or (known.type, known.encoding) != (new.type, new.encoding):
                other = known.type if known.type != new.type else "another definition of it"
                raise BagError(f"{bag.path}: {name} is of type {new.type}, and of {other} in another")
            found[new.name] = known if known.hash else new
            names[name] = new.name
    return {name: found[new] for name, new in names.items()}


def copy(
    bags: Sequence[Bag],
    writer: BagWriter,
    topics: Mapping[str, Topic],
    *,
    start_ns: int = 0,
    end_ns: int | None = None,
    on_progress: Callable[[int, int | None], object] = lambda *_: None,
) -> Contents:
    """Write the messages of bags into another, in the order of their times; returns its contents.

    Args:
        bags: The sources.
        writer: The target, which stays open.
        topics: The topics to copy, as `joined` returns them.
        start_ns: Earliest time, nanoseconds since 1970.
        end_ns: Time before which messages are copied.
        on_progress: Called now and then with the number of messages so far, and of all; None if that is not known.

    Raises:
        BagError: A source cannot be read, or the target cannot be written.
    """
    for topic in dict.fromkeys(topics.values()):
        writer.declare(topic)
    parts = [bag.records(topics, start_ns, end_ns) for bag in bags]
    is_whole = not start_ns and end_ns is None
    total = sum(bag.contents.counts[name] for bag in bags for name in topics.keys() & bag.contents.counts.keys())
    for count, record in enumerate(heapq.merge(*parts, key=lambda record: record.log_ns)):
        if count % TOLD_EVERY == 0:
            on_progress(count, total if is_whole else None)
        writer.add(record._replace(topic=topics[record.topic.name]))
    return writer.contents


def times(bags: Sequence[Bag], start: float | None, end: float | None) -> tuple[int, int | None]:
    """Convert seconds, since 1970 or from the beginning of the first bag, to nanoseconds since 1970."""
    first = min((bag.contents.start_ns for bag in bags if bag.contents.message_count), default=0)

    def absolute(seconds: float) -> int:
        ns = round(seconds * 1e9)
        return ns if seconds >= 1e8 else first + ns

    return 0 if start is None else absolute(start), None if end is None else absolute(end)


def beside(path: Path, suffix: str) -> Path:
    """Return a folder beside a bag for a bag derived from it."""
    return path.with_name(f"{path.stem}_{suffix}")
