"""The list of nodes: state by glyph and word, and the keys that act on the chosen one."""

from __future__ import annotations

import os
import re

import pytest

from graphflow.introspect.concurrency import ConcurrencyReport
from graphflow.machines.rings import Deadlock
from graphflow.machines.wait_graph import ActivityView, Call, WaitGraph
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.nodes import Costs
from tests.tui.nodes import Talker
from tests.tui.stage import Supervised, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def supervised(s: object) -> Supervised:
    found = s.console.hub.supervision  # type: ignore[attr-defined]
    assert isinstance(found, Supervised)
    return found


async def test_states_have_a_glyph_and_a_word() -> None:
    """Running, ended, failed; the cost of a live process; how long it has been up."""
    async with stage(Content("nodes"), nodes=("/a", "/b", "/c")) as s:
        rows = supervised(s).nodes
        rows["/a"]["pid"] = os.getpid()
        rows["/b"]["state"], rows["/c"]["state"] = "ended", "failed"
        rows["/c"]["restarts"] = 3
        await s.look()
        a, b, c = (line for line in s.text.split("\n") if line.startswith((" /a", " /b", " /c")))
        assert "● running" in a
        assert "%" in a
        assert "M" in a
        assert re.search("1m0[5-9]s", a)
        assert "○ ended" in b
        assert "✖ failed" in c
        assert c.rstrip().endswith("3")
        assert "●1 ○1 ✖1" in s.text


async def test_nodes_that_others_have_started(graph: Graph) -> None:
    """They are shown, and cannot be controlled."""
    await graph.start(Talker())
    async with stage(Content("nodes"), graph=graph, supervised=False) as s:
        await s.until("/talker")
        assert "◆ not ours" in s.text
        await s.press("r")
        assert "not started by this graph's supervisor" in s.text


async def test_restart_and_stop_ask_first() -> None:
    """And say what shares the process; a node that has ended restarts at once."""
    async with stage(Content("nodes"), nodes=("/a", "/b")) as s:
        for row in supervised(s).nodes.values():
            row["process"] = "both"
        await s.look()
        await s.press("r")
        assert "shares a process with /b" in s.text
        await s.press("escape")
        assert s.asked == []
        await s.press("r", "r")
        assert s.asked == [{"do": "restart", "node": "/a"}]
        assert "$ graphflow restart /a" in s.text
        await s.press("down", "s", "s")
        assert s.asked[1:] == [{"do": "stop", "node": "/b"}]
        supervised(s).nodes["/b"]["state"] = "failed"
        await s.look()
        await s.press("r")
        assert s.asked[2:] == [{"do": "restart", "node": "/b"}]


@pytest.mark.parametrize(
    ("key", "state", "opens"),
    [("l", "ready", "log /a"), ("p", "ready", "params /a"), ("enter", "failed", "crash /a")],
)
async def test_keys_open_what_belongs_to_the_node(key: str, state: str, opens: str) -> None:
    """Its log, its parameters, the evidence of its end."""
    async with stage(Content("nodes"), nodes=("/a",)) as s:
        supervised(s).nodes["/a"]["state"] = state
        await s.look()
        await s.press(key)
        assert [str(p.content) for p in s.console.window.panes()] == ["nodes", opens]


async def test_finding(graph: Graph) -> None:
    """Typing narrows the list; escape widens it."""
    async with stage(Content("nodes"), nodes=("/arm", "/leg", "/left_arm")) as s:
        await s.look()
        await s.press("slash")
        await s.type("arm")
        assert "/leg" not in s.text
        assert "/left_arm" in s.text
        await s.press("enter", "escape")
        await s.look()
        assert "/leg" in s.text


def test_costs() -> None:
    """Of a live process; none of one that is not there."""
    costs = Costs()
    found = costs.look(os.getpid())
    assert found is not None
    assert found[1] > 1e6
    assert costs.look(2**30) is None


async def test_columns_go_where_there_is_no_room_for_them() -> None:
    """A number is whole, or not there."""
    async with stage(Content("nodes"), size=(32, 20)) as s:
        await s.until("● running")
        head = s.text.split("\n")[1]
        assert head.split() == ["node", "state", "rate"]
        await s.pilot.resize_terminal(100, 20)
        await s.until("cpu")


async def test_a_node_in_a_ring_says_so(graph: Graph) -> None:
    """However well its process runs."""
    async with stage(Content("nodes"), graph=graph) as s:
        live = s.console.hub.live
        assert live is not None
        activity = ActivityView("a", "timer tick", "/talker", ("g",), Call("1", "/x"))
        live.concurrency = ConcurrencyReport(WaitGraph({"a": activity}), ["a ring"], {})
        live.deadlocks = [Deadlock(("a",), (), (), is_likely=False)]
        live.want = lambda what: None  # type: ignore[method-assign]
        await s.until("✖ deadlock")
