"""The output of `bag info`, in the terms of `ros2 bag info`."""

from __future__ import annotations

import time
from collections.abc import Iterator

from graphflow.bag.contents import Topic
from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import EVENTS
from graphflow.qos import Qos


def lines(bag: Bag, sort: str = "name", *, verbose: bool = False) -> Iterator[str]:
    """Return the lines.

    Args:
        sort: `name`, `type` or `count`.
        verbose: Whether QoS, hash and definition are included.
    """
    whole = bag.contents
    topics = sorted(whole.topics.values(), key=lambda t: (_key(t, whole.counts, sort), t.name))
    yield ""
    yield from _listed("Files:", [file.path.name for file in bag.files])
    yield f"Bag size:          {size(bag.size)}"
    yield f"Storage id:        {bag.storage}"
    yield f"ROS Distro:        {bag.distro or 'unknown'}"
    yield f"Duration:          {(whole.end_ns - whole.start_ns) / 1e9:.9f}s"
    yield f"Start:             {moment(whole.start_ns)}"
    yield f"End:               {moment(whole.end_ns)}"
    yield f"Messages:          {sum(n for name, n in whole.counts.items() if not name.endswith(EVENTS))}"
    plain = [topic for topic in topics if not topic.name.endswith(EVENTS)]
    yield from _listed("Topic information:", [_row(topic, whole.counts) for topic in plain])
    services = [topic for topic in topics if topic.name.endswith(EVENTS)]
    yield f"Services:          {len(services)}"
    yield from _listed("Service information:", [_service(topic, whole.counts) for topic in services])
    if not whole.is_whole:
        yield "Note:              it was not closed properly; this is what can be read: graphflow bag recover mends it"
    for topic in plain if verbose else ():
        yield ""
        yield f"{topic.name}: {topic.type} {topic.hash}"
        yield from (f"  {_qos(qos)}" for qos in topic.qos)
        yield from (f"  | {line}" for line in topic.definition.splitlines())


def as_json(bag: Bag) -> dict[str, object]:
    """Return the information for programs."""
    whole = bag.contents
    return {
        "files": [str(file.path) for file in bag.files],
        "size": bag.size,
        "storage": bag.storage,
        "distro": bag.distro,
        "start_ns": whole.start_ns,
        "end_ns": whole.end_ns,
        "messages": whole.message_count,
        "whole": whole.is_whole,
        "topics": [
            {"name": t.name, "type": t.type, "hash": t.hash, "messages": whole.counts[t.name], "encoding": t.encoding}
            for t in whole.topics.values()
        ],
    }


def topics_of(count: int) -> str:
    """Return a number of topics in words."""
    return f"{count:,} topic{'s' if count != 1 else ''}"


def size(count: float) -> str:
    """Format a number of bytes, 1024-based as in rosbag2."""
    for unit in ("B", "KiB", "MiB"):
        if count < 1024:
            return f"{count:.1f} {unit}" if unit != "B" else f"{count:.0f} B"
        count /= 1024
    return f"{count:.1f} GiB"


def moment(ns: int) -> str:
    """Format a time as a date, and in seconds since 1970."""
    if ns <= 0 or ns >= 1 << 63:
        return "none"
    text = time.strftime("%b %d %Y %H:%M:%S", time.localtime(ns // 10**9))
    return f"{text}.{ns % 10**9:09d} ({ns // 10**9}.{ns % 10**9:09d})"


def _key(topic: Topic, counts: dict[str, int], sort: str) -> tuple[int, str]:
    return {"name": (0, topic.name), "type": (0, topic.type), "count": (counts[topic.name], "")}[sort]


def _listed(head: str, rows: list[str]) -> Iterator[str]:
    yield f"{head:<18} {rows[0]}" if rows else head
    yield from (f"{'':<18} {row}" for row in rows[1:])


def _row(topic: Topic, counts: dict[str, int]) -> str:
    form = f"Serialization Format: {topic.encoding}"
    return f"Topic: {topic.name} | Type: {topic.type} | Count: {counts[topic.name]} | {form}"


def _service(topic: Topic, counts: dict[str, int]) -> str:
    name, type_ = topic.name.removesuffix(EVENTS), topic.type.removesuffix("_Event")
    return (
        f"Service: {name} | Type: {type_} | Event Count: {counts[topic.name]} | Serialization Format: {topic.encoding}"
    )


def _qos(qos: Qos) -> str:
    return f"{qos.reliability.name} {qos.durability.name} {qos.history.name} ({qos.depth})".lower()
