"""Requested topics, services and times that bags do not have."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import EVENTS, Choice
from graphflow.errors import BagError
from graphflow.names import did_you_mean


def remarks(bags: Sequence[Bag], choice: Choice, others: Collection[str] = ()) -> list[str]:
    """Return remarks on the names that none of the bags has.

    Args:
        choice: The requested topics, services and types, excluded ones included.
        others: Further topics, such as those to rename.
    """
    topics = {name for bag in bags for name in bag.contents.topics}
    types = {topic.type for bag in bags for topic in bag.contents.topics.values()}
    services = {name.removesuffix(EVENTS) for name in topics if name.endswith(EVENTS)}
    return [
        *_absent("topic", choice.topics | choice.exclude | {*others}, topics),
        *_absent("call of the service", choice.services | choice.exclude_services, services),
        *_absent("topic of type", choice.types | choice.exclude_types, types),
    ]


def check_messages(
    bags: Sequence[Bag],
    topics: Collection[str],
    notes: Sequence[str] = (),
    start_ns: int = 0,
    end_ns: int | None = None,
) -> None:
    """Check that bags have messages of some topics in some time. Bags without any messages pass.

    Args:
        notes: Remarks on names that the bags do not have, for the error.
        start_ns: Earliest time, nanoseconds since 1970.
        end_ns: Time before which messages count.

    Raises:
        BagError: There are none.
    """
    filled = [bag for bag in bags if bag.contents.message_count]
    counted = {name for name in topics if any(bag.contents.counts.get(name) for bag in filled)}
    is_whole = not start_ns and end_ns is None
    if not filled or (
        counted and (is_whole or any(next(bag.records(counted, start_ns, end_ns), None) for bag in bags))
    ):
        return
    path = ", ".join(str(bag.path) for bag in bags)
    if not topics:
        known = sorted({name for bag in bags for name in bag.contents.topics})
        raise BagError(f"{path}: " + ("; ".join(notes) or f"no topic matches; there is {', '.join(known)}"))
    first_ns = min(bag.contents.start_ns for bag in filled)
    last_ns = max(bag.contents.end_ns for bag in filled)
    start = f" from {(start_ns - first_ns) / 1e9:g} s on" if start_ns > first_ns else ""
    end = "" if end_ns is None else f" before {(end_ns - first_ns) / 1e9:g} s"
    whole = f"; it lasts {(last_ns - first_ns) / 1e9:g} s" if start or end else ""
    raise BagError(f"{path}: no message of {', '.join(sorted(topics))}{start}{end}{whole}")


def _absent(what: str, named: Collection[str], there: Collection[str]) -> Iterator[str]:
    return (f"no {what} {name}{did_you_mean(name, there)}" for name in sorted({*named} - {*there}))
