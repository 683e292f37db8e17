"""Groups, as the handlers of a node share them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from graphflow import (
    CallTimeout,
    Group,
    Node,
    service,
    subscription,
)
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.rcl_interfaces.srv import ListParameters
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from tests.runtime.cast import Log


async def test_each_group_is_one_group(graph: Graph) -> None:
    """Groups made in passing are told apart, also when one takes the place of another in memory."""
    node, gate = Node("n"), asyncio.Event()
    running: list[int] = []

    def make(n: int) -> Callable[[String], Any]:
        async def handler(_: String) -> None:
            running.append(n)
            await gate.wait()

        return handler

    for n in range(8):
        node.create_subscription(String, "x", make(n), group=Group(1))
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.settle()

    assert sorted(running) == list(range(8))
    gate.set()


@pytest.mark.parametrize(("limit", "together"), [(1, 1), (2, 2), (None, 4)])
async def test_a_declared_group_holds_for_its_node(graph: Graph, limit: int | None, together: int) -> None:
    """Handlers of one group exclude each other as far as its limit says, in each node for itself."""
    peak: dict[str, int] = {}
    gate = asyncio.Event()

    class Crowd(Node):
        group = Group(limit)

        async def go_in(self) -> None:
            peak[self.name] = peak.get(self.name, 0) + 1
            await gate.wait()

        @subscription(String, "x", group=group)
        async def first(self, _: String) -> None:
            await self.go_in()

        @subscription(String, "x", group=group)
        async def second(self, _: String) -> None:
            await self.go_in()

    await graph.start(Crowd("one"), Crowd("two"))
    for _ in range(2):
        graph.publisher(String, "/x").publish(String())
    await graph.settle()

    assert peak == {"one": together, "two": together}
    gate.set()


async def test_the_default_group_of_a_class(graph: Graph) -> None:
    """`default_group = Group(1)` gives rclpy's way back: nothing of the node runs beside anything else."""
    log, gate = Log(), asyncio.Event()

    class Classic(Node):
        default_group = Group(1)

        @subscription(String, "x")
        async def first(self, _: String) -> None:
            log("first")
            await gate.wait()

        @subscription(String, "x")
        async def second(self, _: String) -> None:
            log("second")

    node = Classic()
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.settle()
    assert log == ["first"]

    # Parameter services are never held up by a group of the user's.
    await graph.call(ListParameters, "/classic/list_parameters", ListParameters.Request())
    gate.set()
    await graph.settle()
    assert log == ["first", "second"]


async def test_a_call_to_oneself_in_one_group_waits_for_ever(graph: Graph) -> None:
    """A slot is held across every await, so a handler that calls its own group gets no answer in time."""

    class Narcissus(Node):
        default_group = Group(1)

        def __init__(self) -> None:
            super().__init__()
            self.client = self.create_client(AddTwoInts, "add")
            self.outcome = Log()

        @service(AddTwoInts, "add")
        async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
            return AddTwoInts.Response(sum=request.a + request.b)

        @subscription(String, "x")
        async def ask(self, _: String) -> None:
            try:
                self.outcome(await self.client.call(AddTwoInts.Request(), timeout=1.0))
            except CallTimeout:
                self.outcome("late")

    node = Narcissus()
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.clock.advance(1.0)

    assert node.outcome == ["late"]
