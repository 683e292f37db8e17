"""Moves that end a deadlock: each was tried on the snapshot."""

from __future__ import annotations

import pytest

from graphflow.machines.waits.group_moves import Move, moves
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, explained
from graphflow.machines.waits.wait_graph import ActivityView, Call, GroupView, QueueView, WaitGraph


def ring(second: QueueView, *, own: str = "main") -> WaitGraph:
    """/a's tick holds its group and calls /b's get, which calls back what waits for that group."""
    return WaitGraph(
        {
            "tick": ActivityView("tick", "timer tick", "/a", ("ga",), Call("1", "/b/get")),
            "get": ActivityView("get", "service get", "/b", (), Call("2", "/a/reset"), serves="1"),
        },
        {"ga": GroupView("ga", own, "/a")},
        {"q": second},
    )


def found(graph: WaitGraph) -> tuple[Deadlock, list[Move]]:
    [deadlock] = explained(graph, deadlocked(graph))
    return deadlock, moves(deadlock, graph)


def test_the_handler_that_is_waited_for_gets_a_group_of_its_own() -> None:
    """With the command that makes it so."""
    _, [move] = found(ring(QueueView("q", "service reset", "/a", ("ga",), ("2",), 1)))
    assert move == Move("/a", ("reset",), "reset_group")
    assert move.command == "graphflow groups move /a reset reset_group"


@pytest.mark.parametrize(
    "graph",
    [
        ring(QueueView("q", "service reset", "/a", ("ga",), ("2",), 1), own=""),
        ring(QueueView("q", "reply reset", "/a", ("ga",), ("2",), 1)),
    ],
    ids=["a handler's own queue", "a client in a group"],
)
def test_where_no_move_helps(graph: WaitGraph) -> None:
    """None is offered."""
    assert found(graph)[1] == []


def test_a_handler_that_calls_itself_is_not_moved() -> None:
    """In its new group it would wait for its own earlier run again."""
    graph = WaitGraph(
        {
            "tick": ActivityView("tick", "timer tick", "/a", (), Call("0", "/a/fact")),
            "three": ActivityView("three", "service fact", "/a", ("ga",), Call("1", "/a/fact"), serves="0"),
            "two": ActivityView("two", "service fact", "/a", ("ga",), Call("2", "/a/fact"), serves="1"),
        },
        {"ga": GroupView("ga", "main", "/a", limit=2)},
        {"q": QueueView("q", "service fact", "/a", ("ga",), ("2",), 1)},
    )
    assert found(graph)[1] == []


def test_a_move_that_leaves_the_ring_is_not_offered() -> None:
    """The handler would go on and wait for the same again."""
    graph = ring(QueueView("q", "service reset", "/a", ("ga", "gb"), ("2",), 1))
    deadlock, made = found(graph)
    assert set(deadlock.ring) == {"tick", "get"}
    assert len(made) == 1
