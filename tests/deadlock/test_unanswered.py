"""Errors of calls that got no answer in time: they say where the server is."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from graphflow import CallTimeout, Client, Node, service
from graphflow.deadlock.unanswered import where_served
from graphflow.errors import Place
from graphflow.machines.waits.wait_graph import FREE, ActivityView, GroupView, QueueView, WaitGraph
from graphflow.machines.waits.wait_graph_json import to_json
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.testing import Graph
from tests.cases import slow


class Waiter(Node):
    """A service that waits for an event."""

    def __init__(self) -> None:
        super().__init__()
        self.arrived = asyncio.Event()

    @service(Trigger, "arrival")
    async def arrival(self, _: Trigger.Request) -> Trigger.Response:
        await self.arrived.wait()
        return Trigger.Response(success=True)


class Asker(Node):
    """A node with a client of it."""

    ask = Client(Trigger, "arrival")


LINE = Waiter.arrival.__code__.co_firstlineno + 2


async def end_of(graph: Graph, asker: Asker, timeout: float) -> str:
    """Return the error of a call."""
    call = asyncio.ensure_future(asker.ask.call(Trigger.Request(), timeout=timeout))
    await graph.settle()
    await graph.clock.advance(timeout)
    with pytest.raises(CallTimeout) as caught:
        await call
    return str(caught.value)


@slow
async def test_a_server_of_this_process(graph: Graph) -> None:
    """The line of its wait is named; for the request that waits behind another, that one's."""
    waiter, asker = Waiter(), Asker()
    await graph.start(waiter, asker)
    text = await end_of(graph, asker, 10.0)
    assert text.startswith("/arrival did not answer within 10 s; service arrival of /waiter waits")
    assert f"in test_unanswered.py:{LINE}" in text
    text = await end_of(graph, asker, 5.0)
    assert "; service arrival of /waiter begins after service arrival of /waiter, which waits" in text


async def test_short_calls(graph: Graph) -> None:
    """A poll expects to time out, and is told nothing more."""
    waiter, asker = Waiter(), Asker()
    await graph.start(waiter, asker)
    assert await end_of(graph, asker, 0.5) == "/arrival did not answer within 0.5 s"


def process(reply: bytes | None) -> Any:
    """A process that gets this reply."""

    def ask_reports(key: str, limit: float, told: Callable[[list[bytes], bool], None]) -> None:
        assert key == "@graphflow/0/waits/b"
        told([] if reply is None else [reply], False)
        told([], True)

    session = SimpleNamespace(zid="a", ask_reports=ask_reports)
    return SimpleNamespace(session=session, domain=0, loop=asyncio.get_running_loop())


RUN = ActivityView("b:1", "service add", "/b", ("g",), FREE, "1:1", Place("/x/b.py", 7), "add", 3.2, process="b")
QUEUE = QueueView("b:q1", "service sub", "/b", ("g",), ("1:2",), 1, process="b")
GRAPH = WaitGraph({RUN.id: RUN}, {"g": GroupView("g", "io", "/b")}, {QUEUE.id: QUEUE})


@pytest.mark.parametrize(
    ("call", "text"),
    [
        ("1:1", "service add of /b waits in b.py:7, for 3 s so far"),
        ("1:2", "service sub of /b begins after service add of /b, which waits in b.py:7, for 3 s so far"),
        ("1:3", ""),
    ],
)
async def test_a_server_of_another_process(graphflow_runner: asyncio.Runner, call: str, text: str) -> None:
    """It is asked; a request that it does not know, for example since it is on its way, is not explained."""
    reply = json.dumps({**to_json(GRAPH), "process": "b"}).encode()
    snapshot: Any = None
    assert await where_served(process(reply), snapshot, call, "b") == text


@pytest.mark.parametrize("reply", [None, b"", b"{", b"[]", b'{"activities": 3}'])
async def test_answers_that_say_nothing(graphflow_runner: asyncio.Runner, reply: bytes | None) -> None:
    """A process that is silent, or sends nonsense, leaves the error as it is."""
    snapshot: Any = None
    assert await where_served(process(reply), snapshot, "1:1", "b") == ""
