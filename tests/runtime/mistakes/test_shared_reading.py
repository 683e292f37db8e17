"""Two loops that read one subscription."""

from __future__ import annotations

import pytest

from graphflow import Node, Subscription, task
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.shared_reading import CHECKS
from graphflow.testing import Graph

Caplog = pytest.LogCaptureFixture


class Reader(Node):
    """Has a subscription, and a task that reads it."""

    words = Subscription(String, "words")

    @task
    async def first(self) -> None:
        async for _ in self.words:
            self.log.debug("first")


class Both(Reader):
    """A second task reads it, too."""

    @task
    async def second(self) -> None:
        async for _ in self.words:
            self.log.debug("second")


class Pool(Node):
    """Several tasks of one loop share the messages."""

    words = Subscription(String, "words")

    async def on_start(self) -> None:
        for number in range(3):
            self.spawn(self.work, number)

    async def work(self, number: int) -> None:
        async for _ in self.words:
            self.log.debug("%d", number)


class OneByOne(Node):
    """A loop that ends, and then another."""

    words = Subscription(String, "words")

    @task
    async def read(self) -> None:
        async for _ in self.words:
            break
        async for _ in self.words:
            self.log.debug("second")


class InTurn(Node):
    """Two tasks, the second of which begins when the first no longer reads."""

    words = Subscription(String, "words")

    @task
    async def first(self) -> None:
        async for _ in self.words:
            break
        self.spawn(self.second)
        await self.clock.sleep(1e6)

    async def second(self) -> None:
        async for _ in self.words:
            self.log.debug("second")


class Slow(Node):
    """Two loops of which the one that gets the first message works on it for a while."""

    words = Subscription(String, "words")

    @task
    async def first(self) -> None:
        async for _ in self.words:
            await self.clock.sleep(2.5)

    @task
    async def second(self) -> None:
        async for _ in self.words:
            await self.clock.sleep(2.5)


def told(caplog: Caplog) -> list[str]:
    return [text for text in caplog.messages if "is read in" in text]


async def publish(graph: Graph, times: int) -> None:
    node = Node("talker")
    made = node.create_publisher(String, "words")
    await graph.start(node)
    for _ in range(times):
        made.publish(String())
        await graph.clock.advance(0.6)


async def test_two_loops(graph: Graph, caplog: Caplog) -> None:
    """Are told once, with both lines."""
    await graph.start(Both())
    await publish(graph, 5)
    (text,) = told(caplog)
    assert text.startswith("/words is read in test_shared_reading.py:22 and in test_shared_reading.py:31, and each ")


async def test_two_loops_that_wait_together_only_later(graph: Graph, caplog: Caplog) -> None:
    """They are inspected again until both wait."""
    await graph.start(Slow())
    await publish(graph, 1)
    await graph.clock.advance(1.0)
    assert told(caplog) == []
    await graph.clock.advance(3.0)
    assert len(told(caplog)) == 1


@pytest.mark.parametrize("cls", [Reader, Pool, OneByOne, InTurn])
async def test_those_that_do_not_compete(cls: type[Node], graph: Graph, caplog: Caplog) -> None:
    """Are not told."""
    await graph.start(cls())
    await publish(graph, 5)
    await graph.clock.advance(2.0 * CHECKS)
    assert told(caplog) == []


async def test_a_node_that_stops(graph: Graph, caplog: Caplog) -> None:
    """Ends the inspections."""
    node = Both()
    await graph.start(node)
    await graph.stop(node)
    await graph.clock.advance(60.0)
    assert told(caplog) == []
