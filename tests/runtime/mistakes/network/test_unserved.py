"""Waits for servers that no node offers."""

from __future__ import annotations

from contextlib import suppress

import pytest

from graphflow import ActionClient, Client, Node, ServiceUnavailable, task
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.testing import Graph
from tests.cases import slow
from tests.runtime.cast import Adder, Server


class Waiting(Node):
    """Waits for a service and an action."""

    adder = Client(AddTwoInts, "ad")
    rabbits = ActionClient(Fibonacci, "fibonaci")

    @task
    async def wait_for_adder(self) -> None:
        while not await self.adder.wait_ready(1.0):
            """Wait again."""

    @task
    async def wait_for_rabbits(self) -> None:
        await self.rabbits.wait_ready()


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.message for record in caplog.records if "wait_ready" in record.message]


@slow
async def test_they_are_told_with_the_nearest_name(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Once per client, even for repeated waits; an action counts as one."""
    await graph.start(Adder(), Server(), Waiting())
    await graph.clock.advance(2.9)
    assert told(caplog) == []

    await graph.clock.advance(20.0)
    first, second = sorted(told(caplog))
    assert first.startswith("wait_ready has waited for 3 s (test_unserved.py:")
    assert "in wait_for_adder): no node offers the service /ad [example_interfaces/srv/AddTwoInts]" in first
    assert "did you mean '/add'?" in first
    assert "in wait_for_rabbits): no node offers the action /fibonaci" in second
    assert "did you mean '/fibonacci'?" in second


async def test_a_server_that_comes_in_time(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """There is no warning, and a wait for its successor starts again."""
    node = Node("n")
    client = node.create_client(AddTwoInts, "add")
    await graph.start(node)
    node.spawn(client.wait_ready)
    await graph.clock.advance(2.0)
    adder = Adder()
    await graph.start(adder)
    await graph.settle()
    await graph.stop(adder)
    node.spawn(client.wait_ready)
    await graph.clock.advance(2.0)
    assert told(caplog) == []
    await graph.clock.advance(1.0)
    assert len(told(caplog)) == 1


async def test_a_program_that_does_without(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A program that polls, or handles a call's error, gets no warning."""
    node = Node("n")
    asked, called = node.create_client(AddTwoInts, "add"), node.create_client(AddTwoInts, "sum")

    async def ask() -> None:
        while True:
            await asked.wait_ready(0.5)
            await node.clock.sleep(2.5)

    async def call() -> None:
        while True:
            with suppress(ServiceUnavailable):
                await called.call(AddTwoInts.Request())

    await graph.start(node)
    node.spawn(ask)
    node.spawn(call)
    await graph.clock.advance(20.0)
    assert told(caplog) == []


async def test_the_node_of_a_command(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """There is no warning: the command reports it."""
    node = Node("_hidden")
    client = node.create_client(AddTwoInts, "add")
    await graph.start(node)
    node.spawn(client.wait_ready)
    await graph.clock.advance(10.0)
    assert told(caplog) == []


async def test_several_waits_of_one_client(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """They are reported once, however long the report takes."""
    node = Node("n")
    client = node.create_client(AddTwoInts, "add")
    await graph.start(node)
    nobody = client._unserved._nobody

    async def slow() -> str:
        await node.clock.sleep(0.2)
        return await nobody()

    client._unserved._nobody = slow
    node.spawn(client.wait_ready)
    node.spawn(client.wait_ready)
    await graph.clock.advance(10.0)
    assert len(told(caplog)) == 1
