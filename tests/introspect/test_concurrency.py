"""Slots and waits, from the answers of all processes."""

from __future__ import annotations

import json
from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.introspect import concurrency
from graphflow.introspect.graph_view import View
from graphflow.machines.cache import GraphCache
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    GroupView,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    WaitGraph,
)
from graphflow.machines.waits.wait_graph_json import to_json
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.process import ProcessToken


def activity(node: str, *, holds: str = "", wait: Condition = FREE, serves: str = "", **more: Any) -> ActivityView:
    return ActivityView(f"{node}!", "timer ask", node, (holds,) if holds else (), wait, serves, **more)


def crossing() -> list[WaitGraph]:
    """Two processes: /a and /b each hold a group and wait for the other's answer, which is queued for that group."""
    pictures = []
    for node, other in (("/a", "/b"), ("/b", "/a")):
        group = GroupView(f"{node}.work", "work", node)
        asks = activity(
            node, holds=group.id, wait=Call(f"{node}:1", f"{other}/answer"), place=Place("x.py", 3, 1), function="ask",
            age=2.0 if node == "/a" else 1.0, left=4.0004 if node == "/a" else None,
        )  # fmt: skip
        queue = QueueView(f"{node}.answer", "service answer", node, (group.id,), (f"{other}:1",), waiting=1)
        pictures.append(WaitGraph({asks.id: asks}, {group.id: group}, {queue.id: queue}))
    return pictures


def reply(picture: WaitGraph, process: str = "z", **more: Any) -> bytes:
    said = {"process": process, "stalls": [], "reports": [], "nodes": {}, "blocked_for": 0.0, "late": 0, "longest": 0.0}
    return json.dumps({**to_json(picture), **said, **more}).encode()


def test_answers_are_joined() -> None:
    """Pictures, reports, stalls and groups of all processes; blocked and late loops by their nodes."""
    groups: dict[str, Any] = {name: [{"name": "work"}] for name in ("/a", "/b", "/c")}
    read = concurrency.read(
        [
            reply(crossing()[0], "1", nodes={"/a": groups["/a"]}, reports=["DEADLOCK"]),
            reply(
                crossing()[1], "2", nodes={"/c": groups["/c"], "/b": groups["/b"]}, stalls=["STALL"], blocked_for=1.5
            ),
            reply(WaitGraph(), "3", nodes={"/d": []}, late=2, longest=0.75),
        ]
    )
    assert set(read.graph.activities) == {"/a!", "/b!"}
    assert (read.reports, read.stalls, read.unreadable) == (["DEADLOCK"], ["STALL"], 0)
    assert read.nodes == {**groups, "/d": []}
    assert read.processes == {"1", "2", "3"}
    assert read.blocked == [("/b and /c", 1.5)]
    assert read.late == [("/d", 2, 0.75)]


@pytest.mark.parametrize(
    "data", [b"", b"\xff", b"{}", b"[]", b"1", b"[" * 100_000, reply(WaitGraph(), v=99), reply(WaitGraph(), nodes=3)]
)
def test_an_answer_that_cannot_be_read_is_counted(data: bytes) -> None:
    """An answer of another version, or an invalid one, does not affect the others."""
    read = concurrency.read([data, reply(crossing()[0], nodes={"/a": []})])
    assert read.unreadable == 1
    assert set(read.graph.activities) == {"/a!"}


def test_rows() -> None:
    """Rows are the activities that hold or wait, the longest first, and whether they are deadlocked."""
    read = concurrency.read([reply(picture) for picture in reversed(crossing())])
    first, second = concurrency.rows(read)
    assert first == {
        "activity": "timer ask of /a",
        "holds": "work",
        "waits_for": "the response of /b/answer",
        "since": 2.0,
        "left": 4.0,
        "place": "x.py:3:1 in ask",
        "stuck": True,
    }
    assert (second["activity"], second["left"], second["stuck"]) == ("timer ask of /b", None, True)
    assert concurrency.stuck(read) == {"/a!", "/b!"}


def test_half_a_ring_is_not_stuck() -> None:
    """While the other process has not answered, nothing is claimed."""
    read = concurrency.read([reply(crossing()[0])])
    assert concurrency.stuck(read) == set()
    assert [row["stuck"] for row in concurrency.rows(read)] == [False]


def test_who_runs_freely_has_no_row() -> None:
    """An activity that neither holds a group nor waits has no row."""
    group = GroupView("/b.work", "work", "/b")
    runs = {a.id: a for a in (activity("/a"), activity("/b", holds=group.id))}
    [row] = concurrency.rows(concurrency.read([reply(WaitGraph(runs, {group.id: group}))]))
    assert (row["activity"], row["holds"], row["waits_for"], row["place"]) == ("timer ask of /b", "work", "", "")


def test_queued() -> None:
    """Handlers with work that waits, the group they need, and who holds it; others are left out."""
    picture = crossing()[0]
    idle = QueueView("/a.idle", "service idle", "/a", ("/a.work",))
    own = QueueView("/a.tick", "timer tick", "/a", ("/a.tick!",), waiting=2, dropped=5)
    picture = WaitGraph(picture.activities, picture.groups, {**picture.queues, idle.id: idle, own.id: own})
    assert concurrency.queued(concurrency.read([reply(picture)])) == [
        {
            "handler": "service answer of /a",
            "group": "work",
            "held_by": ["timer ask of /a"],
            "waiting": 1,
            "dropped": 0,
        },
        {"handler": "timer tick of /a", "group": "", "held_by": [], "waiting": 2, "dropped": 5},
    ]


SERVER = ActivityView("s", "service add", "/s", serves="c:1")
GRAPH = WaitGraph({"s": SERVER}, {"g": GroupView("g", "work", "/s")})


@pytest.mark.parametrize(
    ("condition", "text"),
    [
        (Call("c:2", "/add"), "the response of /add"),
        (Call("c:1", "/add"), "the response of /add (which service add of /s is handling)"),
        (Call("goal:1", "/drive"), "the goal of /drive"),
        (Call("goal:1", ""), "the end of a goal"),
        (Slot("g", 1), "a slot of group 'work'"),
        (Slot("h", 1), "a slot"),
        (Opening("/add"), "service /add to open"),
        (Opening("/go/_action/send_goal"), "action /go to open"),
        (Join("s"), "service add of /s"),
        (Join("t"), "another task"),
        (SetBy("self.pose", ()), "self.pose"),
        (All((SetBy("self.x", ()), SetBy("self.y", ()))), "self.x and self.y"),
        (AnyOf((SetBy("self.x", ()), Join("t"))), "self.x or another task"),
        (FREE, ""),
    ],
)
def test_a_condition_in_words(condition: Condition, text: str) -> None:
    """Conditions are described as `waits` prints them."""
    assert concurrency.describe(condition, GRAPH) == text


class Seen(View):
    """A look at a graph of three processes of graphflow, and a node of another kind."""

    def __init__(self) -> None:
        self.domain = 0
        nodes = [("1", "a"), ("2", "c"), ("2", "b"), ("3", "_hidden"), ("9", "ros")]
        entities = [Entity(0, zid, n, n, Kind.NODE, "/", name) for n, (zid, name) in enumerate(nodes)]
        self.cache = GraphCache(e.token for e in entities)

    def processes(self) -> dict[str, ProcessToken]:
        return {zid: ProcessToken(zid, "0", int(zid), "elsewhere") for zid in "123"}


def test_who_has_not_answered() -> None:
    """Processes of graphflow with nodes that are not hidden; others cannot be expected to answer."""
    why = "it is stopped, or something holds its interpreter, or it cannot be reached"
    read = concurrency.read([reply(WaitGraph(), "1")])
    assert concurrency.unresponsive(read, Seen()) == [
        f"NODE UNRESPONSIVE: /b and /c (process 2 on elsewhere) did not answer: {why}"
    ]
