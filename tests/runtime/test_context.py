"""The state shared by the nodes of a process."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import Context, Node
from graphflow.errors import GraphflowError
from graphflow.executor.clock import WallClock
from graphflow.machines.cache import GraphChange
from graphflow.testing import Graph
from graphflow.transport.memory import Network


async def test_a_context_has_what_it_is_given(graphflow_runner: asyncio.Runner) -> None:
    """Session, domain and clock; without a clock, the system's."""
    session = Network().session(asyncio.get_running_loop())
    context = Context(session, domain=7)

    assert context.session is session
    assert context.domain == 7
    assert isinstance(context.clock, WallClock)
    assert [context.next_id() for _ in range(3)] == [0, 1, 2]
    await context.close()


async def test_it_knows_who_is_there_already(graph: Graph) -> None:
    """A context that comes late has the same picture as an early one."""
    early = Node("early")
    await graph.start(early)
    late = Context(graph.network.session(asyncio.get_running_loop()))
    await graph.settle()

    assert list(late.cache) == list(early.context.cache)
    await late.close()


async def test_domains_do_not_see_each_other(graph: Graph) -> None:
    """A context's picture is of its own domain."""
    await graph.start(Node("n"))
    other = Context(graph.network.session(asyncio.get_running_loop()), domain=1)
    await graph.settle()

    assert other.cache.nodes() == []
    await other.close()


BARE: dict[str, Any] = {"start_parameter_services": False, "enable_rosout": False, "enable_logger_service": False}
"""A node that is a token and nothing else."""


async def test_listeners_hear_of_changes(graph: Graph) -> None:
    """Each entity that comes or goes, until they stop listening."""
    watcher, node = Node("watcher"), Node("n", **BARE)
    await graph.start(watcher)
    changes: list[GraphChange] = []
    stop = watcher.context.on_change(changes.append)
    await graph.start(node)
    await graph.stop(node)
    stop()
    await graph.start(Node("later"))

    assert [(c.entity.node_name, c.alive) for c in changes] == [("/n", True), ("/n", False)]


async def test_waiting_for_a_condition(graph: Graph) -> None:
    """It ends when the graph makes it true, at once when it is true already."""
    watcher = Node("watcher")
    await graph.start(watcher)
    context = watcher.context
    waiting = asyncio.create_task(context.wait_for(lambda: "/n" in context.cache.nodes()))
    await graph.start(Node("other"))
    assert not waiting.done()
    await graph.start(Node("n"))

    assert waiting.done()
    await context.wait_for(lambda: True)


async def test_a_cancelled_wait_listens_no_more(graph: Graph) -> None:
    """Its condition is not evaluated again."""
    watcher = Node("watcher")
    await graph.start(watcher)
    asked: list[int] = []

    def condition() -> bool:
        asked.append(1)
        return False

    waiting = asyncio.create_task(watcher.context.wait_for(condition))
    await graph.settle()
    waiting.cancel()
    await graph.settle()
    asked.clear()
    await graph.start(Node("n"))

    assert waiting.cancelled()
    assert asked == []


async def test_a_condition_that_fails(graph: Graph) -> None:
    """Its error goes to who waits, and other listeners hear of the change."""
    watcher = Node("watcher")
    await graph.start(watcher)
    answers: list[bool] = [False]
    waiting = asyncio.create_task(watcher.context.wait_for(lambda: answers.pop()))
    await graph.settle()
    changes: list[GraphChange] = []
    watcher.context.on_change(changes.append)
    await graph.start(Node("n"))

    assert changes
    with pytest.raises(IndexError):
        await waiting


@pytest.mark.parametrize("value", ["x", "-1", "1.5"])
async def test_a_wrong_domain(graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    """The error names the variable, before anything is opened."""
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", value)

    with pytest.raises(GraphflowError, match="GRAPHFLOW_DOMAIN"):
        await Context.open()
