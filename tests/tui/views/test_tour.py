"""The guide: a description of the situation, and the keys that lead on."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from graphflow.graph.resolve import load
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.stage import Supervised, stage
from tests.tui.views.test_groups import FILE, Left, Right

pytestmark = pytest.mark.usefixtures("graphflow_runner")

OPTIONS = {"title": "Two nodes ask each other.", "step": "4/11 crossing", "seconds": 60.0}


@slow
async def test_from_the_ring_to_the_next_example(graph: Graph, tmp_path: Path) -> None:
    """The guide names f, then w and n; n leaves for the next example."""
    file = tmp_path / "lab.yaml"
    file.write_text(FILE)
    graph.deadlock = "report"
    await graph.start(Left(), Right())
    async with stage(Content("tour", options=OPTIONS), graph=graph, size=(110, 40), folder=tmp_path) as s:
        assert isinstance(s.console.hub.supervision, Supervised)
        s.console.hub.supervision.plan = load(file, [])
        await s.until("Everything runs. In a moment it will not")
        assert "tour 4/11 crossing" in s.text
        assert "Two nodes ask each other." in s.text
        going = asyncio.ensure_future(graph.call(Empty, "/left/go", Empty.Request(), timeout=1000.0))
        await graph.settle()
        for _ in range(8):
            await graph.clock.advance(0.25)
            await graph.settle()
        await s.until("f  end it, while the graph runs: give get of /left a group of its own")
        await s.press("f")
        await s.until("w  keep it: write it into the graph file")
        await asyncio.wait_for(going, 5.0)
        await s.press("w", "w")
        await s.until("the graph file keeps it that way")
        await s.press("n")
        await s.until(lambda: s.console._exit)
        assert s.console.return_value == "next"


async def test_what_no_ring_explains() -> None:
    """After its time, an example without a deadlock is described as such; n shows it repaired."""
    async with stage(Content("tour", options={**OPTIONS, "seconds": -2.0}), size=(110, 40)) as s:
        await s.until("things happen in the wrong order")
        await s.press("n")
        await s.until(lambda: s.console._exit)
        assert s.console.return_value == "fixed"


async def test_repaired() -> None:
    """The comment in the repaired graph file is shown."""
    async with stage(Content("tour", options={**OPTIONS, "fixed": "override:\n  /a: {}"}), size=(110, 40)) as s:
        await s.until("Repaired, and it runs")
        assert "override:" in s.text
        await s.press("n")
        await s.until(lambda: s.console._exit)
        assert s.console.return_value == "next"
