"""Nodes that share a process: the first ones, and those that join and leave."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import Context, GraphflowError, Node, task
from graphflow.runtime.company import Company
from graphflow.testing import Graph


class Quiet(Node):
    """Does nothing."""


class Failing(Node):
    """Fails when it is told to."""

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


def company(graph: Graph) -> tuple[Company, asyncio.Event]:
    stop = asyncio.Event()
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
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
    """Concerns nobody else."""
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
