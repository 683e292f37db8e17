"""Bags for tests."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from graphflow.bag.contents import Record, Topic
from graphflow.bag.formats.definitions import known
from graphflow.bag.writer import BagWriter
from graphflow.msgs import registry
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.qos import DEFAULT, Durability, Qos

LATCHED = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)
SECOND = 10**9
START = 1_700_000_000 * SECOND


def topic_of(name: str, type_: type = String, *qos: Qos) -> Topic:
    type_name = type_.SCHEMA.name  # type: ignore[attr-defined]
    return Topic(name, type_name, registry.hash_of(type_name), known(type_name), qos or (DEFAULT,))


CHATTER = topic_of("/chatter")
COUNT = topic_of("/count", Int32)
MAP = topic_of("/map", String, LATCHED)


def record(topic: Topic, message: Any, seconds: float, sequence: int = 1) -> Record:
    ns = START + round(seconds * SECOND)
    data = message if isinstance(message, bytes) else message.to_bytes()
    return Record(topic, ns, ns - 1000, sequence, data)


def some_records(seconds: float = 2.0, hz: float = 10.0) -> list[Record]:
    """A map, then strings and numbers in turn."""
    found = [record(MAP, String(data="map"), 0.0)]
    for n in range(round(seconds * hz)):
        found.append(record(CHATTER, String(data=f"hello {n}"), n / hz, n + 1))
        found.append(record(COUNT, Int32(data=n), n / hz + 0.5 / hz, n + 1))
    return found


def write(folder: Path, records: Iterable[Record] | None = None, **options: Any) -> Path:
    """A bag of these messages."""
    with BagWriter(folder, **options) as writer:
        for one in some_records() if records is None else records:
            writer.add(one)
    return folder


LAB = Topic(
    "/things",
    "bag_lab_msgs/msg/Thing",
    "",
    f"Part part\nuint8 x\n{'=' * 80}\nMSG: bag_lab_msgs/Part\nint32[2] y\n",
)
"""Of a type that is nowhere installed."""
THING = b"\0\1\0\0" + b"\1\0\0\0\2\0\0\0\7"
