"""Subscriptions that their own node feeds."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import Node, Publisher, subscription
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.runtime.context import Context
from graphflow.runtime.mistakes.echoes import LOOP, Echo
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph, ManualClock
from tests.cases import slow

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
    counts.echo.follow(has_own=True)
    for messages in (LOOP, LOOP - 1, LOOP):
        await counts.second(messages)
    assert counts.told == []
    await counts.second(LOOP + 1)
    await counts.second(LOOP)
    counts.echo.follow(has_own=True)
    await counts.second(LOOP)
    await counts.second(LOOP)
    assert counts.told == [LOOP + 1]


async def test_the_watch_ends_with_the_publisher(graph: Graph) -> None:
    """Until there is another one of the node."""
    counts = Counts(graph.clock)
    counts.echo.follow(has_own=True)
    await counts.second(LOOP)
    counts.echo.follow(has_own=False)
    await counts.second(LOOP)
    counts.echo.follow(has_own=True)
    await counts.second(LOOP)
    assert counts.told == []
    await counts.second(LOOP)
    assert counts.told == [LOOP]


async def test_a_loop_is_told_again_at_its_end(graph: Graph) -> None:
    """The warning comes below the output that hides the first; a loop that has ended before is not told again."""
    counts = Counts(graph.clock)
    counts.echo.follow(has_own=True)
    for _ in range(4):
        await counts.second(LOOP)
    counts.echo.stop()
    counts.echo.stop()
    assert counts.told == [LOOP, LOOP]
    counts.echo.follow(has_own=True)
    await counts.second(3)
    counts.echo.stop()
    assert counts.told == [LOOP, LOOP]


async def test_what_came_before_the_watch(graph: Graph) -> None:
    """Does not count."""
    counts = Counts(graph.clock)
    await counts.second(LOOP)
    counts.echo.follow(has_own=True)
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


@slow
@pytest.mark.parametrize("others", [0, 1])
async def test_a_node_that_feeds_itself(graph: Graph, caplog: Caplog, others: int) -> None:
    """Is warned of it once, whoever else publishes the topic."""
    node = Looping()
    for number in range(others):
        other = Node(f"other{number}")
        other.create_publisher(Int32, "number")
        await graph.start(other)
    await graph.start(node)
    for _ in range(6):
        node.left = LOOP
        node.number.publish(Int32())
        await graph.clock.advance(1.0)
    told = [r.getMessage() for r in caplog.records if "publishes itself" in r.getMessage()]
    assert told == [
        f"this node hears what it publishes itself on /number, {LOOP} messages a second: if the handler publishes "
        "there, that never ends; give one of the two another topic"
    ]


class IgnoredTalker(Node):
    """Publishes."""

    out = Publisher(String, "chatter")


class Ear(Node):
    """Takes what other processes publish."""

    @subscription(String, "chatter", ignore_local=True)
    def heard(self, message: String) -> None:
        """Do nothing."""


class Both(Ear):
    """Publishes, and takes what others publish."""

    out = Publisher(String, "chatter")


def ignored(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [text for text in caplog.messages if "nothing is received" in text]


async def test_publishers_of_this_process(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """They are named once."""
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    for node in (IgnoredTalker(), Ear()):
        await core_of(node).start(context)
        graph.nodes.append(node)
    await graph.clock.advance(10.0)
    assert ignored(caplog) == [
        "/chatter: nothing is received: /ignored_talker is in this process, whose messages ignore_local=True skips; "
        "leave it out, or give one of the two nodes a process of its own"
    ]


async def test_its_own_publisher(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A node that ignores itself waits for others on purpose."""
    await graph.start(Both())
    await graph.clock.advance(10.0)
    assert ignored(caplog) == []
