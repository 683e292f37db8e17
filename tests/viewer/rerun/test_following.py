"""A graph, and a bag, followed into a recording."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

rr = pytest.importorskip("rerun", reason="the extra `rerun` is not installed")

from graphflow import Node, Publisher
from graphflow.bag.contents import Record, Topic
from graphflow.bag.reader import Bag
from graphflow.bag.writer import BagWriter
from graphflow.msgs import registry
from graphflow.msgs.std_msgs.msg import Empty, Float64, String
from graphflow.testing import Graph
from graphflow.viewer.rerun.following import Following, replay


class Talker(Node):
    words = Publisher(String, "words")
    nothing = Publisher(Empty, "nothing")


class Logged:
    """A recording that keeps what it is given."""

    def __init__(self) -> None:
        self.added: list[tuple[str, str]] = []

    def add(self, topic: str, type_name: str, message: Any, received_ns: int) -> None:
        self.added.append((topic, type_name))

    def close(self) -> None:
        self.added.append(("closed", ""))


async def test_a_graph(graph: Graph) -> None:
    """Topics that can be shown are followed, also those that come later; others are left out."""
    talker, watcher, logged = Talker(), Node("watcher"), Logged()
    await graph.start(talker, watcher)
    following = Following(watcher, logged)  # type: ignore[arg-type]
    following.look()
    await graph.settle()
    talker.words.publish(String(data="a"))
    talker.nothing.publish(Empty())
    late = talker.create_publisher(Float64, "late", 10)
    await graph.settle()
    following.look()
    await graph.settle()
    late.publish(Float64(data=1.0))
    await graph.settle()
    shown = [entry for entry in logged.added if entry[0] in ("/words", "/late", "/nothing")]
    assert shown == [("/words", "std_msgs/msg/String"), ("/late", "std_msgs/msg/Float64")]
    assert following.count >= 2


def test_a_bag(tmp_path: Path) -> None:
    """Its messages that can be shown are logged, at their times."""
    with BagWriter(tmp_path / "bag") as writer:
        for name, message in (("/words", String(data="a")), ("/nothing", Empty())):
            type_name = type(message).SCHEMA.name
            data = registry.codec(type_name).encode(message)
            writer.add(Record(Topic(name, type_name), 1, 1, 0, bytes(data)))
    logged = Logged()
    assert replay(Bag(tmp_path / "bag"), logged) == 1  # type: ignore[arg-type]
    assert logged.added == [("/words", "std_msgs/msg/String"), ("closed", "")]
