"""Changes of groups that end a deadlock: each was tried on the snapshot."""

from __future__ import annotations

from dataclasses import replace

from graphflow.interface import GroupChange
from graphflow.machines.regrouping import Regrouping
from graphflow.machines.waits.group_fixes import Fix, Limit, Thread, fixes
from graphflow.machines.waits.group_moves import Move
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import explained
from graphflow.machines.waits.wait_graph import ActivityView, Call, GroupView, QueueView, WaitGraph

SELF_CALL = WaitGraph(
    {"tick": ActivityView("tick", "timer tick", "/a", ("ga",), Call("1", "/b/get"))},
    {"ga": GroupView("ga", "main", "/a")},
    {"q": QueueView("q", "reply get", "/a", ("ga",), ("1",), 1)},
)
BLOCKED = WaitGraph(
    {"tick": ActivityView("tick", "timer tick", "/a", (), Call("1", "/a/add"), process="p", is_async=False)},
    {"own": GroupView("own", "", "/a")},
    {
        "q": QueueView("q", "service add", "/a", ("own",), ("1",), 1, process="p"),
        "t": QueueView("t", "timer tick", "/a", ("own",), process="p"),
    },
    {"p": "tick"},
)


def found(graph: WaitGraph) -> list[Fix]:
    [deadlock] = explained(graph, deadlocked(graph))
    return fixes(deadlock, graph)


def test_a_larger_limit_where_no_move_helps() -> None:
    """One more run than there are, with the command and the lines of a graph file for it."""
    [limit] = found(SELF_CALL)
    assert limit == Limit("/a", "main", 2)
    assert limit.command == "graphflow groups limit /a main 2"
    assert limit.title == "allow 2 runs at a time in group 'main' of /a"
    assert limit.made_in(Regrouping()).groups == {"main": GroupChange(limit=2, sets_limit=True)}


def test_a_move_comes_first() -> None:
    """Two handlers in one group may share state; a handler in a group of its own changes less."""
    graph = WaitGraph(
        {
            "tick": ActivityView("tick", "timer tick", "/a", ("ga",), Call("1", "/b/get")),
            "get": ActivityView("get", "service get", "/b", (), Call("2", "/a/reset"), serves="1"),
        },
        {"ga": GroupView("ga", "main", "/a")},
        {"q": QueueView("q", "service reset", "/a", ("ga",), ("2",), 1)},
    )
    assert found(graph) == [Move("/a", ("reset",), "reset_group"), Limit("/a", "main", 2)]


def test_a_limit_that_no_graph_file_can_set() -> None:
    """Is not offered: the group was made by code."""
    group = replace(SELF_CALL.groups["ga"], is_declared=False)
    assert found(replace(SELF_CALL, groups={"ga": group})) == []


def test_a_handler_that_blocks_the_loop() -> None:
    """Runs in a thread, in a group for that."""
    [thread] = found(BLOCKED)
    assert thread == Thread("/a", ("tick",))
    assert (thread.command, thread.title) == ("graphflow groups thread /a tick", "run tick of /a in a thread")
    assert thread.made_in(Regrouping()).groups == {"blocking": GroupChange(("tick",), thread=True)}


def test_a_handler_that_cannot_run_in_a_thread() -> None:
    """As `async` ones and tasks cannot: it is changed in the code."""
    tick = BLOCKED.activities["tick"]
    assert found(replace(BLOCKED, activities={"tick": replace(tick, is_async=True)})) == []
    assert found(replace(BLOCKED, queues={"q": BLOCKED.queues["q"]})) == []
    undeclared = replace(BLOCKED.queues["t"], is_declared=False)
    assert found(replace(BLOCKED, queues={**BLOCKED.queues, "t": undeclared})) == []


def test_a_larger_limit_that_ends_nothing() -> None:
    """Is not offered: another group keeps the handler out as well."""
    tick, queue = replace(SELF_CALL.activities["tick"], holds=("ga", "gb")), SELF_CALL.queues["q"]
    groups = {**SELF_CALL.groups, "gb": GroupView("gb", "more", "/a")}
    graph = replace(
        SELF_CALL, activities={"tick": tick}, groups=groups, queues={"q": replace(queue, needs=("ga", "gb"))}
    )
    assert [fix for fix in found(graph) if isinstance(fix, Limit)] == []


def test_a_limit_by_which_several_are_kept_out() -> None:
    """Is offered once."""
    [deadlock] = explained(SELF_CALL, deadlocked(SELF_CALL))
    twice = replace(deadlock, ring=deadlock.ring * 2, edges=deadlock.edges * 2)
    assert fixes(twice, SELF_CALL) == [Limit("/a", "main", 2)]
