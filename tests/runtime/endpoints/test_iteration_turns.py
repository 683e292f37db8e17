"""When a reader of messages lets others run: the time is set by hand."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

import pytest

from graphflow import Node
from graphflow.executor.runner import SLICE
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.runtime.endpoints import subscriptions
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.testing import Graph


class Time:
    """The time as subscriptions see it, and how often they have let others run."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 100.0
        self.step = 0.0
        """Seconds that pass with each look at the time."""
        self.pauses = 0
        monkeypatch.setattr(subscriptions, "monotonic", self._monotonic)
        monkeypatch.setattr(subscriptions, "asyncio", SimpleNamespace(**{**vars(asyncio), "sleep": self._sleep}))

    def _monotonic(self) -> float:
        self.now += self.step
        return self.now

    async def _sleep(self, delay: float) -> None:
        self.pauses += 1
        await asyncio.sleep(delay)


@pytest.fixture
def time(monkeypatch: pytest.MonkeyPatch) -> Time:
    return Time(monkeypatch)


async def hearing(graph: Graph, *numbers: int) -> TopicSubscription[Int32]:
    """Return a subscription to which these numbers have come."""
    node = Node("reader")
    heard = node.create_subscription(Int32, "numbers", None, 50)
    await graph.start(node)
    await send(graph, *numbers)
    return heard


async def send(graph: Graph, *numbers: int) -> None:
    publisher = graph.publisher(Int32, "/numbers")
    for number in numbers:
        publisher.publish(Int32(data=number))
    await graph.settle()


async def test_messages_within_a_slice(graph: Graph, time: Time) -> None:
    """They are read without a pause, until the slice is over; then the next one begins."""
    heard = await hearing(graph, 1, 2, 3, 4, 5)
    found: list[tuple[int, int]] = []
    for passes in (0.0, 0.0, 0.0, SLICE, 0.0):
        time.now += passes
        message, _ = await heard.next_with_info()
        found.append((message.data, time.pauses))
    assert found == [(1, 1), (2, 1), (3, 1), (4, 2), (5, 2)]


async def test_a_message_that_was_waited_for(graph: Graph, time: Time) -> None:
    """Others had their turn meanwhile."""
    heard = await hearing(graph)
    reading = asyncio.ensure_future(heard.next_with_info())
    await graph.settle()
    time.now += 10.0
    await send(graph, 7)
    assert (await reading)[0].data == 7
    assert time.pauses == 0


async def test_a_message_that_another_reader_takes_meanwhile(graph: Graph, time: Time) -> None:
    """The reader that has let it go first waits for the next one."""
    time.step = 1.0
    heard = await hearing(graph, 1)
    first, second = (asyncio.ensure_future(heard.next_with_info()) for _ in range(2))
    assert (await first)[0].data == 1
    assert time.pauses == 2
    await send(graph, 2)
    assert (await second)[0].data == 2
