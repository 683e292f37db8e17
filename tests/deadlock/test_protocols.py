"""What the search needs of nodes and processes is what the protocols say: no more, and what the runtime has."""

from __future__ import annotations

import asyncio
import inspect

import pytest

from graphflow.deadlock.protocols import ProcessContext, Subject
from graphflow.deadlock.search import Search
from graphflow.machines.waits.wait_graph import FREE
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.deadlock.stage import Stage, begin


def names_of(protocol: type) -> list[str]:
    """What a protocol asks for."""
    return [name for name, _ in inspect.getmembers_static(protocol) if not name.startswith("_")]


async def test_what_the_runtime_has(graph: Graph) -> None:
    """A node is a subject, its context a process."""
    node = Node("n")
    await graph.start(node)
    subject: Subject = core_of(node)
    surroundings: ProcessContext = node.context

    assert len(names_of(Subject)) == 12
    assert len(names_of(ProcessContext)) == 10
    assert [name for name in names_of(Subject) if not hasattr(subject, name)] == []
    assert [name for name in names_of(ProcessContext) if not hasattr(surroundings, name)] == []
    assert list(surroundings.nodes) == [subject]


async def test_what_is_enough(graphflow_runner: asyncio.Runner, caplog: pytest.LogCaptureFixture) -> None:
    """The search finds a deadlock where there is nothing but what the protocols name."""
    stage = Stage()
    search = Search(stage, "report")
    actor = stage.actor()
    group = actor.groups.named("motion")

    async def waits(_: object) -> None:
        future = stage.loop.create_future()
        with stage.ledger.call(future, b"\1" * 16, 7, "/add", 0, None):
            await future

    tick = stage.handler(actor, "tick", waits, group, kind="timer")
    add = stage.handler(actor, "add", group=group, kind="service")
    await begin(tick, "now")
    stage.requests.append((add, b"\1" * 16, 7))
    await stage.clock.advance(1.0)

    [text] = caplog.messages
    assert text.startswith(
        "DEADLOCK: timer tick of /robot waits for itself\n  timer tick of /robot holds group 'motion'"
    )
    [activity] = search.snapshot.take().activities.values()
    assert activity.wait != FREE
    search.close()
