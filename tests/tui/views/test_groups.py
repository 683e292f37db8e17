"""A deadlock drawn as a ring, ended by a key, and the change written into the graph file."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from graphflow import Client, Group, Node, service, task
from graphflow.graph.resolve import load
from graphflow.machines.waits.group_fixes import Limit, Thread
from graphflow.machines.waits.rings import Deadlock
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.groups import Applied, Groups
from tests.cases import slow
from tests.tui.stage import Supervised, record, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

FILE = """\
deadlock: report
nodes:
  /left:
    class: tests.tui.views.test_groups:Left
  /right: {class: tests.tui.views.test_groups:Right}
"""


class Left(Node):
    """Calls the other node while it cannot respond."""

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
        """Does nothing."""


class Right(Node):
    """Calls back."""

    node_name = "right"
    main = Group(1)
    ask = Client(Empty, "/left/get")

    @service(Empty, "~/get", group=main)
    async def get(self, request: Empty.Request) -> Empty.Response:
        await self.ask.call(Empty.Request(), timeout=None)
        return Empty.Response()


@slow
async def test_a_deadlock_is_seen_ended_and_written(graph: Graph, tmp_path: Path) -> None:
    """The ring has source locations; f moves a handler, the graph goes on; w writes the move after a diff."""
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
        await s.until("f  give get of /left a group of its own")
        assert "F  allow 2 runs at a time in group 'main' of /left   (if its handlers share no state)" in s.text
        assert "$ graphflow groups move /left get get_group" in s.text
        await s.press("f")
        await s.until("✔ It moves again.")
        await graph.settle()
        await asyncio.wait_for(going, 5.0)
        assert {"do": "announce", "text": "groups move /left get get_group"} in s.asked
        await s.press("w")
        await s.until("+    concurrency: {get_group: [get]}")
        await s.press("w")
        await s.until("written to")
        assert "    concurrency: {get_group: [get]}\n" in file.read_text()
        assert load(file, []).nodes[0].concurrency["get_group"].change.handlers == ("get",)
        await s.press("a")
        await s.until("get_group limit 1 □")


@slow
async def test_nothing_to_do() -> None:
    """Without a deadlock the keys say so."""
    async with stage(Content("groups")) as s:
        await s.press("f")
        await s.until("no deadlock")
        await s.press("w")
        await s.until("nothing was changed here yet")


@slow
@pytest.mark.parametrize(
    ("fix", "told_after"), [(Limit("/left", "main", 2), 3.0), (Thread("/left", ("go",)), 13.0)], ids=["limit", "thread"]
)
async def test_a_change_that_ends_nothing(fix: Limit | Thread, told_after: float) -> None:
    """An ineffective change is reported after a while, by newer reports; later if the node is restarted."""
    async with stage(Content("groups")) as s:
        view = s.view
        assert isinstance(view, Groups)
        rings = {frozenset({("go", "get")}): "a ring"}
        view._rings = lambda: rings  # type: ignore[method-assign]
        view._applied = applied = Applied(fix, rings, 100.0)
        view._evaluate(applied, 99.0, 200.0)
        view._evaluate(applied, 101.0, 100.0 + told_after - 1.5)
        assert (view._applied, view._outcome) == (applied, "")
        view._evaluate(applied, 101.0, 100.0 + told_after)
        assert view._applied is None
        assert view._outcome.startswith("Still stuck")


async def test_a_change_that_ends_one_of_two() -> None:
    """The effect is reported above the remaining deadlock, which looks like the one before."""
    async with stage(Content("groups")) as s:
        view = s.view
        assert isinstance(view, Groups)
        fix = Limit("/left", "main", 2)
        view._changes, view._deadlocks = [fix], [Deadlock((), (), (), False)]
        view._rings = lambda: {frozenset({("go", "put")}): "another ring"}  # type: ignore[method-assign]
        view._evaluate(Applied(fix, {frozenset({("go", "get")}): "a ring"}, 100.0), 101.0, 101.0)
        assert [row.text.plain for row in view._outcome_rows()] == [" ● One ended; a new one, 1 deadlock now: f again."]
        rows = [row.text.plain for row in view._change_rows()]
        assert rows[0].startswith("   done here: allow 2 runs")


@slow
async def test_a_race(graph: Graph) -> None:
    """The whole report is shown; enter opens the line known from /rosout, if there is one."""
    async with stage(Content("groups"), graph=graph) as s:
        await s.until("no deadlock; for lost updates: graphflow up --races")
        told = record("RACE: an update of self.x is lost", level=2, node="/left")
        more = [
            told._replace(text="  timer a of /left read it in a.py:1 and waited,", is_more=True),
            record("something else", level=2, node="/right"),
            told._replace(text="  and timer a has overwritten that in a.py:3.", is_more=True),
            told._replace(text="a warning"),
            told._replace(text="  with another line", is_more=True),
        ]
        s.console.hub.logs.add([told, *more])
        await s.until(" ⇄ RACE: an update of self.x is lost")
        assert "   and timer a has overwritten that in a.py:3." in s.text
        assert "something else" not in s.text
        assert "with another line" not in s.text
        await s.press("f")
        await s.until("a race is ended in the code: enter opens it")
        await s.press("enter")
        await s.until("older than the console")
        assert s.console.hub.live is not None
        s.console.hub.live._rosout_records.append((told.stamp, told.text, f"{__file__}:3"))
        await s.press("enter")
        await s.until("source ")
        await s.until("test_groups.py:3")


@slow
async def test_a_thread_for_a_node_that_others_have_started(graph: Graph) -> None:
    """A thread for a node of others requires a change of its code."""
    async with stage(Content("groups"), graph=graph, supervised=False) as s:
        view = s.view
        assert isinstance(view, Groups)
        await view._apply(Thread("/left", ("go",)))
        await s.until("was not started by this graph's supervisor")
        assert view._changes == []
