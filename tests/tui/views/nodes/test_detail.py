"""Details of the selected node in tabs, which follow the cursor and take what would have split the window."""

from __future__ import annotations

import pytest

from graphflow.testing import Graph
from graphflow.tui.app import Console
from graphflow.tui.panes import Content, Split
from graphflow.tui.views.nodes.detail import TABS
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import Stage, record, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

RECORDS = [record("I talk"), record("I lift", "/arm/left")]


def beside(console: Console) -> None:
    """The list of nodes, with the details of the selected one below."""
    windows = console.windows
    root = Split("rows", [windows.make_pane(Content("nodes")), windows.make_pane(Content("detail"))])
    windows.select(windows.open("both", root))
    console.changed()


def title(s: Stage) -> str:
    return next(line for line in s.text.split("\n") if "params topics" in line or "[params]" in line).strip(" ▌")


@slow
async def test_a_narrow_pane(graph: Graph) -> None:
    """In a narrow pane the title names the open tab, and the number of tabs."""
    await graph.start(Talker())
    async with stage(Content("log"), graph=graph, records=RECORDS, size=(40, 24)) as s:
        beside(s.console)
        await s.until("  [all] 1 of 6")
        await s.until(lambda: s.console.hub.selected == "/talker")
        await s.press("l")
        await s.until("/talker  [log] 2 of 6")


@slow
async def test_it_follows_the_cursor(graph: Graph) -> None:
    """The view begins with all logs; then it shows the selected node in the chosen tab, without another pane."""
    await graph.start(Talker())
    async with stage(Content("log"), graph=graph, records=RECORDS) as s:
        beside(s.console)
        await s.until("[all] log params topics groups history")
        await s.until("I talk")
        assert "I lift" in s.text
        await s.until(lambda: s.console.hub.selected == "/talker")
        await s.press("l")
        await s.until("/talker  all [log] params")
        assert "I lift" not in s.text
        await s.prefix("up")
        await s.press("down")
        await s.until("/arm/left  all [log] params")
        await s.until("I lift")
        assert "I talk" not in s.text
        await s.press("up", "p")
        await s.until("/talker  all log [params]")
        await s.until("How often.")
        assert len(s.console.window.numbers) == 2
        for word in ("topics", "groups", "history", "all", "log"):
            await s.press("]")
            await s.until(f"[{word}]")
        await s.press("[")
        await s.until("[all]")
        assert s.view.NAME == "log"
        await s.until(lambda: s.console.focused is s.view.focus_target)
        s.console.workspace.store_contents()
        assert [p.content for p in s.console.window.panes()][1] == Content("detail", "", {"tab": "all"})


@slow
async def test_another_node_has_a_pane_of_its_own(graph: Graph) -> None:
    """Content about another node is not opened in a tab."""
    await graph.start(Talker())
    async with stage(Content("log"), graph=graph) as s:
        beside(s.console)
        await s.until("[all]")
        s.console.open_beside(Content("log", "/arm/left"))
        await s.until("log /arm/left")
        assert len(s.console.window.numbers) == 3


async def test_before_a_node_is_chosen() -> None:
    """Without a selected node the tabs are empty, and say so."""
    async with stage(Content("detail"), nodes=()) as s:
        await s.press("]")
        await s.until("choose a node in the list of nodes first")
        assert next(iter(TABS)) == "all"
