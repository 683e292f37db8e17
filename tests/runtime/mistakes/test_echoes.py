"""Subscriptions that their own node feeds."""

from __future__ import annotations

import pytest

from graphflow import Node, Publisher, subscription
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.runtime.mistakes.echoes import LOOP, Echo
from graphflow.testing import Graph, ManualClock

Caplog = pytest.LogCaptureFixture


class Counts:
    """The received messages of a subscription, and the warnings."""

    def __init__(self, clock: ManualClock) -> None:
        self.clock, self.received = clock, 0
        self.told: list[int] = []
        self.echo = Echo(clock, lambda: self.received, self.told.append)

    async def second(self, messages: int) -> None:
        self.received += messages
        await self.clock.advance(1.0)


async def test_two_fast_seconds_in_a_row(graph: Graph) -> None:
    """They are reported once; a burst is not."""
    counts = Counts(graph.clock)
    counts.echo.follow(is_alone=True)
    for messages in (LOOP, LOOP - 1, LOOP):
        await counts.second(messages)
    assert counts.told == []
    await counts.second(LOOP + 1)
    await counts.second(LOOP)
    counts.echo.follow(is_alone=True)
    await counts.second(LOOP)
    await counts.second(LOOP)
    assert counts.told == [LOOP + 1]


async def test_another_publisher_ends_the_watch(graph: Graph) -> None:
    """Until that has gone."""
    counts = Counts(graph.clock)
    counts.echo.follow(is_alone=True)
    await counts.second(LOOP)
    counts.echo.follow(is_alone=False)
    await counts.second(LOOP)
    counts.echo.follow(is_alone=True)
    await counts.second(LOOP)
    assert counts.told == []
    await counts.second(LOOP)
    assert counts.told == [LOOP]


async def test_what_came_while_another_published(graph: Graph) -> None:
    """Does not count."""
    counts = Counts(graph.clock)
    await counts.second(LOOP)
    counts.echo.follow(is_alone=True)
    await counts.second(0)
    await counts.second(LOOP)
    assert counts.told == []


class Looping(Node):
    """Publish each received message."""

    number = Publisher(Int32, "number")
    left = 0

    @subscription(Int32, "number")
    def hear(self, message: Int32) -> None:
        self.left -= 1
        if self.left > 0:
            self.number.publish(message)


async def test_a_node_that_feeds_itself(graph: Graph, caplog: Caplog) -> None:
    """Is warned of it; one whose topic another node publishes, too, is not."""
    node = Looping()
    await graph.start(node)
    for _ in range(3):
        node.left = LOOP
        node.number.publish(Int32())
        await graph.clock.advance(1.0)
    told = [r.getMessage() for r in caplog.records if "publishes itself" in r.getMessage()]
    assert told == [
        f"this node hears what it publishes itself on /number, {LOOP} messages a second: if the handler publishes "
        "there, that never ends; publish to another topic, or remap one of the two"
    ]
    other = Node("other")
    await graph.start(other)
    other.create_publisher(Int32, "number")
    await graph.settle()
    caplog.clear()
    for _ in range(3):
        node.left = LOOP
        node.number.publish(Int32())
        await graph.clock.advance(1.0)
    assert "publishes itself" not in caplog.text
