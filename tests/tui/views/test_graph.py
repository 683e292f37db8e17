"""The graph as boxes: the drawing, and its keys."""

from __future__ import annotations

import pytest

from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_the_drawing_and_its_keys(graph: Graph) -> None:
    """Boxes have names; n selects one, enter opens it, M copies the drawing."""
    await graph.start(Talker(), Listener())
    async with stage(Content("graph"), graph=graph, size=(120, 30)) as s:
        await s.until("/chatter")
        assert "╭" in s.text
        assert "▶" in s.text
        await s.press("n")
        assert s.view.chosen() == {"node": "/listener"} or s.view.chosen() == {}
        await s.press("n", "n")
        assert s.view.chosen() == {"topic": "/chatter"}
        await s.press("M")
        assert s.console.clipboard_text.startswith("flowchart LR\n")
        assert s.console.clipboard_text.count("-->") == 2
        await s.press("enter")
        assert str(s.view.content) == "echo /chatter"


async def test_what_is_wider_than_the_pane(graph: Graph) -> None:
    """A drawing wider than the pane says so, and scrolls sideways."""
    await graph.start(Talker(), Listener())
    async with stage(Content("graph"), graph=graph, size=(34, 30)) as s:
        await s.until("←→ more")
        assert "/listener" not in s.text
        await s.press("right", "right")
        await s.until("/listener")
        await s.press("left", "left")
        await s.until("/talker")
