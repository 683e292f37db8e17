"""The ring drawn, ended by a key, and the ending written into the graph file."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from graphflow import Client, Group, Node, service, task
from graphflow.graph.resolve import load
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.stage import Supervised, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

FILE = """\
deadlock: report
nodes:
  /left:
    class: tests.tui.views.test_groups:Left
  /right: {class: tests.tui.views.test_groups:Right}
"""


class Left(Node):
    """Asks the other while it cannot answer."""

    node_name = "left"
    main = Group(1)
    ask = Client(Empty, "/right/get")

    @service(Empty, "~/get", group=main)
    async def get(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @service(Empty, "~/go", group=main)
    async def go(self, request: Empty.Request) -> Empty.Response:
        await self.ask.call(Empty.Request(), timeout=None)
        return Empty.Response()

    @task
    async def begin(self) -> None:
        """Nothing to do."""


class Right(Node):
    """Asks back."""

    node_name = "right"
    main = Group(1)
    ask = Client(Empty, "/left/get")

    @service(Empty, "~/get", group=main)
    async def get(self, request: Empty.Request) -> Empty.Response:
        await self.ask.call(Empty.Request(), timeout=None)
        return Empty.Response()


@slow
async def test_a_deadlock_is_seen_ended_and_written(graph: Graph, tmp_path: Path) -> None:
    """The ring with places; f moves a handler, the graph goes on, w writes the move with the diff shown first."""
    file = tmp_path / "lab.yaml"
    file.write_text(FILE)
    graph.deadlock = "report"
    left = Left()
    await graph.start(left, Right())
    async with stage(Content("groups"), graph=graph, size=(110, 40), folder=tmp_path) as s:
        assert isinstance(s.console.hub.supervision, Supervised)
        s.console.hub.supervision.plan = load(file, [])
        going = asyncio.ensure_future(graph.call(Empty, "/left/go", Empty.Request(), timeout=1000.0))
        await graph.settle()
        for _ in range(8):
            await graph.clock.advance(0.25)
            await graph.settle()
        await s.until("✖ DEADLOCK: 2 callbacks wait for each other in a ring")
        assert "service go of /left" in s.text
        assert "holds group 'main', waits" in s.text
        assert "test_groups.py:" in s.text
        assert "└── back to the first" in s.text
        await s.until("f gives get of /left a group of its own")
        assert "$ graphflow groups move /left get get_group" in s.text
        await s.press("f")
        await s.until("✔ It moves again.")
        await graph.settle()
        await asyncio.wait_for(going, 5.0)
        assert {"do": "announce", "text": "groups move /left get get_group"} in s.asked
        await s.press("w")
        assert "+    concurrency: {get_group: [get]}" in s.text
        await s.press("w")
        await s.until("written to")
        assert "    concurrency: {get_group: [get]}\n" in file.read_text()
        assert load(file, []).nodes[0].concurrency["get_group"].change.handlers == ("get",)
        await s.press("a")
        assert "get_group limit 1 □" in s.text


async def test_nothing_to_do() -> None:
    """Without a deadlock the keys say so."""
    async with stage(Content("groups")) as s:
        await s.press("f")
        assert "no deadlock" in s.text
        await s.press("w")
        assert "nothing was moved" in s.text
