"""The list of nodes: states by glyph and word, and the keys that act on the selected node."""

from __future__ import annotations

import os
import re
import time
from types import SimpleNamespace

import pytest

from graphflow import LifecycleNode, TransitionRefused
from graphflow.introspect.concurrency import ConcurrencyReport
from graphflow.machines.waits.rings import Deadlock
from graphflow.machines.waits.wait_graph import ActivityView, Call, WaitGraph
from graphflow.msgs.lifecycle_msgs.msg import Transition
from graphflow.system import host_name
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.nodes.nodes import LABEL, Costs, Nodes, _label
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import Supervised, record, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def supervised(s: object) -> Supervised:
    found = s.console.hub.supervision  # type: ignore[attr-defined]
    assert isinstance(found, Supervised)
    return found


@slow
async def test_states_have_a_glyph_and_a_word() -> None:
    """Running, ended and failed nodes differ; a live process has its resource use and uptime."""
    async with stage(Content("nodes"), nodes=("/a", "/b", "/c")) as s:
        rows = supervised(s).nodes
        rows["/a"]["pid"] = rows["/b"]["pid"] = os.getpid()
        rows["/b"]["state"], rows["/c"]["state"] = "ended", "failed"
        rows["/c"]["restarts"] = 3
        await s.look()
        a, b, c = (line for line in s.text.split("\n") if line.startswith((" /a", " /b", " /c")))
        assert "● running" in a
        assert "%" in a
        assert "M" in a
        assert re.search("1m0[5-9]s", a)
        assert "○ ended" in b
        assert "%" not in b
        assert "✖ failed" in c
        assert c.rstrip().endswith("3")
        assert "●1 ○1 ✖1" in s.text


async def test_nodes_that_others_have_started(graph: Graph) -> None:
    """Nodes of others are shown, but cannot be controlled."""
    await graph.start(Talker())
    async with stage(Content("nodes"), graph=graph, supervised=False) as s:
        await s.until("/talker")
        assert "◆ not ours" in s.text
        await s.press("r")
        await s.until("not started by this graph's supervisor")


async def test_processes_of_other_machines() -> None:
    """Resource use is not measured for processes on other machines, whose ids mean nothing here."""
    async with stage(Content("nodes")) as s:
        view, hub = s.view, s.console.hub
        assert isinstance(view, Nodes)
        hosts = {"/here": host_name(), "/there": "elsewhere"}
        tokens = {name: SimpleNamespace(pid=7, host=host) for name, host in hosts.items()}
        hub.live = SimpleNamespace(  # type: ignore[assignment]
            processes=tokens, cache=[SimpleNamespace(node_name=name, zid=name) for name in hosts]
        )
        found, hub.live = view._pids_of_others(), None
        assert found == {"/here": 7}


async def test_restart_and_stop_ask_first() -> None:
    """The questions name the nodes that share the process; a node that has ended restarts at once."""
    async with stage(Content("nodes"), nodes=("/a", "/b")) as s:
        for row in supervised(s).nodes.values():
            row["process"] = "both"
        await s.look()
        await s.press("r")
        await s.until("shares a process with /b")
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


@slow
@pytest.mark.parametrize(
    ("key", "state", "opens"),
    [("l", "ready", "log /a"), ("p", "ready", "params /a"), ("enter", "failed", "crash /a")],
)
async def test_keys_open_what_belongs_to_the_node(key: str, state: str, opens: str) -> None:
    """Keys open the node's log, parameters and crash."""
    async with stage(Content("nodes"), nodes=("/a",)) as s:
        supervised(s).nodes["/a"]["state"] = state
        await s.look()
        await s.press(key)
        assert [str(p.content) for p in s.console.window.panes()] == ["nodes", opens]


@slow
async def test_finding(graph: Graph) -> None:
    """Typing narrows the list; escape clears the search."""
    async with stage(Content("nodes"), nodes=("/arm", "/leg", "/left_arm")) as s:
        await s.look()
        await s.press("slash")
        await s.type("arm")
        assert "/leg" not in s.text
        assert "/left_arm" in s.text
        await s.press("enter", "escape")
        await s.look()
        await s.until("/leg")


def test_costs() -> None:
    """A live process has a resource use; a missing one has none."""
    costs = Costs()
    found = costs.look(os.getpid())
    assert found is not None
    assert found[1] > 1e6
    assert costs.look(2**30) is None


@slow
async def test_columns_go_where_there_is_no_room_for_them() -> None:
    """Columns without room are hidden whole: numbers are never cut."""
    async with stage(Content("nodes"), size=(32, 20)) as s:
        await s.until("● running")
        head = s.text.split("\n")[1]
        assert head.split() == ["node", "state", "!", "cpu"]
        await s.pilot.resize_terminal(100, 20)
        await s.until("cpu")


@slow
async def test_a_node_in_a_ring_says_so(graph: Graph) -> None:
    """A deadlocked node is marked even though its process runs."""
    async with stage(Content("nodes"), graph=graph) as s:
        live = s.console.hub.live
        assert live is not None
        activity = ActivityView("a", "timer tick", "/talker", ("g",), Call("1", "/x"))
        live.concurrency = ConcurrencyReport(WaitGraph({"a": activity}), ["a ring"], {})
        live.deadlocks = [Deadlock(("a",), (), (), is_likely=False)]
        live.want = lambda report: None  # type: ignore[method-assign]
        await s.until("∞ deadlock")
        await s.until("●1 ∞1")


async def test_lifecycle_states_errors_and_floods() -> None:
    """Each has its column in the row."""
    async with stage(Content("nodes"), nodes=("/a", "/b"), size=(140, 20)) as s:
        supervised(s).nodes["/a"]["lifecycle"] = "inactive"
        supervised(s).nodes["/b"]["detail"] = "exit code 3"
        await s.look()
        s.console.hub.logs.add([record("bad", "/a", 3), record("so so", "/a", 2)])
        s.console.hub.logs.add([record("noise", "/b")] * 1000)
        view = s.view
        assert isinstance(view, Nodes)
        view._counted_at -= 5.0
        await s.look()
        a, b = (line for line in s.text.split("\n") if line.strip().startswith(("/a", "/b")))
        assert "◒ inactive" in a
        assert "E1 W1" in a
        assert a.rstrip().endswith("bad")
        assert re.search(r"▲\d+/s", b)
        assert b.rstrip().endswith("exit code 3")


@slow
async def test_groups_of_nodes() -> None:
    """Nodes are grouped by namespace or process, folded by a key; a group is not a node."""
    async with stage(Content("nodes"), nodes=("/arm/left", "/talker", "/arm/right")) as s:
        supervised(s).nodes["/talker"]["process"] = "one"
        await s.look()
        await s.press("b")
        await s.look()
        rows = [line.split()[0:2] for line in s.text.split("\n")[2:7]]
        assert rows == [["▾", "/"], ["/talker", "●"], ["▾", "/arm"], ["/arm/left", "●"], ["/arm/right", "●"]]
        await s.press("down", "down", "down", "space")
        await s.until("▸ /arm (2)")
        assert "/arm/left" not in s.text
        assert s.view.chosen() == {}
        await s.press("l")
        assert len(s.console.window.numbers) == 1
        await s.press("enter")
        await s.until("/arm/left")
        await s.press("b")
        await s.look()
        await s.until("▾ one (1)")
        await s.press("b", "b")
        await s.look()
        assert "▾" not in s.text


@slow
async def test_a_life_cycle(graph: Graph) -> None:
    """t offers the transitions available now, and requests one; other nodes have none."""
    node = Lived()
    await graph.start(node, Talker())
    async with stage(Content("nodes"), graph=graph, nodes=("/lived", "/talker")) as s:
        await s.until(lambda: s.view.chosen() == {"node": "/lived"})
        for transition in ("configure", "activate"):
            await s.press("t")
            await s.until("which transition?")
            await s.type(transition[:3])
            await s.press("enter")
            await s.until(f"$ graphflow lifecycle set /lived {transition}")
            await s.until(lambda wanted=f"on_{transition}": wanted in node.done)
        await s.press("t")
        await s.until("/lived is active: which transition?")
        await s.type("dea")
        await s.press("enter")
        await s.until("/lived did not deactivate: l shows its log")
        await s.press("down", "t")
        await s.until(lambda: s.console.messages[-1].endswith("/talker is not a lifecycle node"))


class Lived(LifecycleNode):
    """Refuses to be deactivated."""

    node_name = "lived"

    def __init__(self) -> None:
        super().__init__()
        self.done: list[str] = []

    async def on_configure(self) -> None:
        self.done.append("on_configure")

    async def on_activate(self) -> None:
        self.done.append("on_activate")

    async def on_deactivate(self) -> None:
        raise TransitionRefused("not now")


@slow
async def test_a_state_that_changes_is_seen_at_once() -> None:
    """The list is updated early after events, but once for many of them."""
    async with stage(Content("nodes"), Content("topics")) as s:
        s.view.looked = now = time.monotonic()
        for _ in range(3):
            s.console.handle_supervisor_event({"event": "said", "text": "x"})
        assert now - 1.0 < s.view.looked < now - 0.8
        await s.prefix("1")
        s.view.looked = now = time.monotonic()
        s.console.handle_supervisor_event({"event": "said", "text": "x"})
        assert s.view.looked >= now


def test_labels_of_others_are_plain() -> None:
    """Labels from other processes are limited, and cannot control the terminal."""
    assert _label(Transition(label="\x1b[31mgo\x07" + "x" * 100)) == "go" + "x" * (LABEL - 8)
