"""Parameters: shown with range and origin, edited in place, refused with the node's reason."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.graph.resolve import load
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import Stage, Supervised, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def row(s: Stage, name: str) -> str:
    return next(line for line in s.text.split("\n") if line.strip().startswith(name))


@slow
async def test_what_is_shown(graph: Graph, tmp_path: Path) -> None:
    """Value, type, range, origin and description are shown; changes from elsewhere appear."""
    file = tmp_path / "lab.yaml"
    file.write_text("nodes:\n  /talker:\n    class: tests.tui.nodes:Talker\n    params: {shout: true}\n")
    node = Talker(shout=True)
    await graph.start(node)
    async with stage(Content("params", "/talker"), graph=graph, size=(140, 30), folder=tmp_path) as s:
        assert isinstance(s.console.hub.supervision, Supervised)
        s.console.hub.supervision.plan = load(file, [])
        await s.until("serial")
        await s.until(lambda: "double" in row(s, "rate"))
        rate = row(s, "rate")
        assert "2.0" in rate
        assert "double" in rate
        assert "default" in rate
        assert "How often. [Hz]" in rate
        assert "100" in rate
        assert "lab.yaml:4" in row(s, "shout")
        assert "read-only" in row(s, "serial")
        node.rate = 5.0
        await graph.settle()
        await s.until(lambda: "5.0" in row(s, "rate"))
        assert "changed" in row(s, "rate")


@slow
async def test_changing(graph: Graph) -> None:
    """Enter edits; a refused value is reported with its reason and not kept; the command is shown."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("params", "/talker"), graph=graph, size=(140, 30)) as s:
        await s.until("serial")
        await s.press("enter", "ctrl+u")
        await s.type("200")
        await s.press("enter")
        await s.until("refuses")
        assert node.rate == 2.0
        await s.press("ctrl+u")
        await s.type("7.5")
        await s.press("enter")
        await s.until(lambda: node.rate == 7.5)
        await s.until("$ graphflow param set /talker rate 7.5")
        assert {"do": "announce", "text": "param set /talker rate 7.5"} in s.asked
        await s.press("u")
        await s.until(lambda: node.rate == 2.0)
        await s.until("$ graphflow param set /talker rate 2.0")
        await s.press("u")
        await s.until("no parameter was set in this pane")
        await s.press("down")
        assert s.view.chosen()["parameter"] == "serial"
        await s.press("enter")
        assert "read-only" in s.text.split("\n")[-2]


@slow
async def test_saving(graph: Graph, tmp_path: Path) -> None:
    """Changes are written into the graph file after confirmation, and its comments stay."""
    file = tmp_path / "lab.yaml"
    text = "# my lab\nnodes:\n  /talker:  # talks\n    class: tests.tui.nodes:Talker\n"
    file.write_text(text)
    node = Talker()
    await graph.start(node)
    async with stage(Content("params", "/talker"), graph=graph, size=(120, 40), folder=tmp_path) as s:
        assert isinstance(s.console.hub.supervision, Supervised)
        s.console.hub.supervision.plan = load(file, [])
        await s.until("serial")
        await s.press("ctrl+s")
        await s.until("no parameter has changed")
        node.rate = 3.0
        await graph.settle()
        await s.until(lambda: "3.0" in row(s, "rate"))
        await s.press("ctrl+s")
        await s.until("+    params: {rate: 3.0}")
        assert file.read_text() == text
        await s.press("w")
        await s.until("written to")
        assert file.read_text() == text + "    params: {rate: 3.0}\n"
