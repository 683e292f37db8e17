"""Every view as text, with recorded data: `tests/tui/snapshots/NAME.txt`.

`GRAPHFLOW_SNAPSHOTS=write` rewrites the files; inspect the changes before committing them.
"""

from __future__ import annotations

import os
import re
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from graphflow.console.views import VIEWS
from graphflow.errors import Place
from graphflow.introspect.concurrency import ConcurrencyReport
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import explained
from graphflow.machines.waits.wait_graph import ActivityView, Call, GroupView, QueueView, WaitGraph
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.topics import plot
from tests.cases import sample, slow
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import Stage, record, stage
from tests.tui.views.nodes.test_crash import TRACE

pytestmark = pytest.mark.usefixtures("graphflow_runner")

FOLDER = Path(__file__).parent / "snapshots"
SIZE = (96, 26)
VOLATILE = ("nodes", "hz", "top", "goals", "turtle", "crash")
"""Views with measured numbers: digits and gaps are ignored."""
SOURCE = "def tick(self):\n    return self.add.call(1, 2)\n\n\nclass Arm:\n    pass\n"
TICK, GET = Place("left.py", 12), Place("right.py", 7)
ASKS, ASKS_BACK = Call("1", "/right/get"), Call("2", "/left/get")
RING = WaitGraph(
    {
        "tick": ActivityView("tick", "timer tick", "/left", ("g",), ASKS, place=TICK, function="tick", age=3.0),
        "get": ActivityView("get", "service get", "/right", (), ASKS_BACK, "1", GET, function="get", age=3.0),
    },
    {"g": GroupView("g", "main", "/left")},
    {"q": QueueView("q", "service get", "/left", ("g",), ("2",), 1)},
)

Setup = Callable[[Stage, Graph, Talker], Awaitable[None]]


async def talk(s: Stage, graph: Graph, node: Talker) -> None:
    for i in range(3):
        node.chatter.publish(String(data=f"hello {i}"))
        node.speed.publish(Twist(linear=Vector3(x=0.5 * i)))
        await graph.settle()


async def drive(s: Stage, graph: Graph, node: Talker) -> None:
    await s.until(lambda: any("⠀" < c <= "⣿" for c in s.text), "the picture is drawn")
    node.pose.publish(Pose(x=7.0, y=9.0))
    await graph.settle()


async def send_goal(s: Stage, graph: Graph, node: Talker) -> None:
    client = graph.action_client(Fibonacci, "/fibonacci")
    await graph.settle()
    await client.send_goal(Fibonacci.Goal(order=5))
    await graph.settle()
    await s.until("executing")


async def wait_in_a_ring(s: Stage, graph: Graph, node: Talker) -> None:
    live: Any = s.console.hub.live
    live.want = lambda what: None
    live.concurrency = ConcurrencyReport(RING, ["a ring"], {})
    live.deadlocks = explained(RING, deadlocked(RING))


async def crash(s: Stage, graph: Graph, node: Talker) -> None:
    supervision: Any = s.console.hub.supervision
    supervision.nodes["/talker"] |= {"state": "failed", "detail": "exit code 70 (an error in the node)"}


async def nothing(s: Stage, graph: Graph, node: Talker) -> None:
    """Do nothing: the view fills itself."""


ABOUT = {"echo": "/chatter", "hz": "/chatter", "plot": "/speed.linear.x", "params": "/talker", "crash": "/talker"}
UNTIL = {"params": "serial", "topics": "/chatter", "graph": "/chatter", "calls": "/add", "groups": "back to the first"}
SETUPS: dict[str, Setup] = {
    "echo": talk,
    "hz": talk,
    "plot": talk,
    "turtle": drive,
    "goals": send_goal,
    "groups": wait_in_a_ring,
    "crash": crash,
}


@slow
@pytest.mark.parametrize("view", sample(list(VIEWS)))
async def test_a_view(view: str, graph: Graph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The screen equals the recorded one."""
    monkeypatch.setattr(plot, "SAMPLES_PER_SECOND", 1e9)
    (tmp_path / "arm.py").write_text(SOURCE)
    about = f"{tmp_path / 'arm.py'}:2" if view == "source" else ABOUT.get(view, "")
    records = [record(text, "/talker", 3 if i else 1, float(i), i) for i, text in enumerate(TRACE)]
    node = Talker()
    await graph.start(node, Listener())
    async with stage(Content(view, about), graph=graph, records=records, size=SIZE) as s:
        await s.look()
        await graph.settle()
        await SETUPS.get(view, nothing)(s, graph, node)
        await s.look()
        if view in UNTIL:
            await s.until(UNTIL[view])
        shown = settled(s.text.replace(str(tmp_path), "/lab"), view)
    file = FOLDER / f"{view}.txt"
    if os.environ.get("GRAPHFLOW_SNAPSHOTS") == "write":
        file.write_text(shown, encoding="utf-8")
    assert shown == file.read_text(encoding="utf-8")


def settled(text: str, view: str) -> str:
    """Remove the bars, which have tests of their own, and everything that varies from run to run."""
    text = "\n".join(line.rstrip() for line in text.split("\n")[:-2]).rstrip("\n") + "\n"
    text = re.sub(r"\d\d:\d\d:\d\d", "12:00:00", text)
    if view in VOLATILE:
        text = re.sub(r"\b[0-9a-f]{8}\b", "0", text)
        text = re.sub(r"(\d[\d.]*[smhM%]*)+", "0", text)
        text = re.sub(r"[ ─]{2,}", "  ", text)
    if view == "topics":  # a slow machine takes long enough to measure rates
        text = re.sub(r"rate +fits", "rate  fits", re.sub(r" +\d+\.\d Hz", "", text))
    if view == "top":  # other tests may have left the process a child
        text = re.sub(r" *0\+0", "  0", text)
    if view == "plot":  # the places of the dots depend on the arrival times
        text = re.sub("[ ▔\u2801-\u28ff]+", " ", text)
    if view == "nodes":
        text = re.sub(r"(● running|◆ not ours).*", r"\1 ...", text)
    return text


def test_no_snapshot_is_left_over() -> None:
    """Each snapshot belongs to a view."""
    assert {file.stem for file in FOLDER.glob("*.txt")} == set(VIEWS)
