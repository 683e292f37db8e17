"""Nodes that share a process: the first ones, and those that join and leave."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from graphflow import Context, GraphflowError, Node, task, timer
from graphflow.runtime.ending import StopRequest
from graphflow.runtime.process_nodes import Company
from graphflow.testing import Graph, ManualClock


class Quiet(Node):
    """Does nothing."""


class Failing(Node):
    """Fail on request."""

    def __init__(self) -> None:
        super().__init__()
        self.fail = asyncio.Event()

    @task
    async def wait(self) -> None:
        await self.fail.wait()
        raise ValueError("broken")


class Wrong(Node):
    async def on_start(self) -> None:
        raise GraphflowError("no camera")


class LateClock(ManualClock):
    """Its alarms are always due, as on a loop that handlers block for longer than their periods."""

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> Any:
        return asyncio.get_running_loop().call_soon(callback)


class Ticking(Node):
    """Ticks in each turn of the loop."""

    ticks = 0

    @timer(1.0)
    def tick(self) -> None:
        self.ticks += 1


def company(graph: Graph, clock: ManualClock | None = None) -> tuple[Company, StopRequest]:
    stop = StopRequest()
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=clock or graph.clock)
    return Company(context, stop), stop


async def test_nodes_that_join_are_stopped_with_the_others(graph: Graph) -> None:
    """In reverse order of their coming."""
    made, stop = company(graph)
    order: list[str] = []

    class Last(Node):
        async def on_shutdown(self) -> None:
            order.append(self.name)

    first, second = Last("first"), Last("second")
    running = asyncio.create_task(made.run([first]))
    await graph.settle()
    await made.join(second)
    assert [node.name for node in made.nodes] == ["first", "second"]
    assert second.is_running
    stop.set()
    await running
    assert not first.is_running
    assert not second.is_running
    assert order == ["second", "first"]


async def test_no_tick_begins_after_a_request_to_stop(graph: Graph) -> None:
    """However many turns of the loop it takes to heed it."""
    made, stop = company(graph, LateClock())
    node = Ticking()
    running = asyncio.create_task(made.run([node]))
    while node.ticks < 2:
        await asyncio.sleep(0)
    stop.set()
    ticks = node.ticks
    await running
    assert node.ticks == ticks


async def test_no_tick_begins_after_a_request_to_stop_once_another_has_ended(graph: Graph) -> None:
    """Of the nodes that still run one is stopped first."""
    made, stop = company(graph, LateClock())
    node, other = Ticking(), Node("other")
    running = asyncio.create_task(made.run([node, other]))
    while other not in made._ends or node not in made._ends:
        await asyncio.sleep(0)
    other.shutdown()
    while other in made._ends:
        await asyncio.sleep(0)
    stop.set()
    ticks = node.ticks
    await running
    assert node.ticks == ticks


async def test_a_node_that_leaves(graph: Graph) -> None:
    """The others go on; when the last one ends by itself, so does the company."""
    made, _ = company(graph)
    first, second = Quiet("first"), Quiet("second")
    running = asyncio.create_task(made.run([first, second]))
    await graph.settle()
    await made.leave(first)
    assert not first.is_running
    assert not running.done()
    second.shutdown()
    await asyncio.wait_for(running, 5.0)


async def test_a_node_that_joined_and_fails(graph: Graph) -> None:
    """Ends all, as one of the first would."""
    made, _ = company(graph)
    first, failing = Quiet("first"), Failing()
    running = asyncio.create_task(made.run([first]))
    await graph.settle()
    await made.join(failing)
    failing.fail.set()
    with pytest.raises(ValueError, match="broken"):
        await asyncio.wait_for(running, 5.0)
    assert not first.is_running
    assert not failing.is_running


async def test_a_node_that_cannot_join(graph: Graph) -> None:
    """The other nodes are unaffected."""
    made, stop = company(graph)
    first = Quiet("first")
    running = asyncio.create_task(made.run([first]))
    await graph.settle()
    with pytest.raises(GraphflowError, match="no camera"):
        await made.join(Wrong())
    assert made.nodes == [first]
    assert first.is_running
    stop.set()
    await running
