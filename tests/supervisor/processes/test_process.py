"""One process of a graph: what `ps` says of it."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest

from graphflow.errors import Place, SupervisorError
from graphflow.graph.plan import PlannedNode
from graphflow.interface import GroupChange
from graphflow.machines.process import BLOCKED_STOP_LIMIT, STOP_LIMIT, Exit, State
from graphflow.machines.restarts import Backoff
from graphflow.supervisor.processes.process import Process

HERE = Place("g.yaml", 1, 1)
A = PlannedNode("/a", "x:A", HERE, HERE, process="both", restart=Backoff("always"))
B = PlannedNode("/b", "x:B", HERE, HERE, process="both", critical=True)
PROGRAM = PlannedNode("/p", "", HERE, HERE, command=("sleep", "1"), on_exit="shutdown")


def test_what_its_nodes_say_holds_for_all() -> None:
    """Nodes that share a process have one life: what one of them says of it counts."""
    both = Process("both", [A, B], "both.log")
    assert (both.restarts.backoff.policy, both.is_critical, both.ends_graph) == ("always", True, False)
    assert not both.is_program
    program = Process("/p", [PROGRAM], "p.log")
    assert (program.restarts.backoff.policy, program.ends_graph, program.is_program) == ("never", True, True)


def test_rows() -> None:
    """One for each node; a program has its words where nodes have their class."""
    rows = Process("both", [A, B], "both.log").rows()
    assert [(row["node"], row["class"], row["process"], row["state"], row["restarts"]) for row in rows] == [
        ("/a", "x:A", "both", "pending", 0),
        ("/b", "x:B", "both", "pending", 0),
    ]
    assert Process("/p", [PROGRAM], "p.log").rows()[0]["class"] == "sleep 1"
    named = Process("both", [A, replace(A, name="/c", keeps_names=True)], "both.log").rows()
    assert [row["is_named"] for row in named] == [True, False]


def test_what_is_wrong_with_it() -> None:
    """Its end, the time of its restart, the reason for none, and the loss of lines in its log."""
    process = Process("/p", [PROGRAM], "p.log")
    process.begin()
    process.state, process.log_error = State.READY, "the disk is full"
    assert process.detail == "its log is incomplete: the disk is full"
    process.state, process.exit, process.failed = State.ENDED, Exit(code=3), True
    assert (process.state_name, process.detail) == ("failed", "exit code 3")
    process.given_up = "started again 5 times within 30 s"
    assert (process.state_name, process.detail) == (
        "given_up",
        "exit code 3; given up: started again 5 times within 30 s",
    )
    process.state, process.delay, process.since = State.WAITING, 5.0, time.time()
    assert process.state_name == "waiting"
    assert process.detail.startswith("exit code 3; it is started again in ")


def test_a_new_start_forgets() -> None:
    """The state of the one before is forgotten; the restart is counted."""
    process = Process("both", [A, B], "both.log")
    process.begin()
    process.waiting_for.clear()
    process.exit, process.error, process.failed, process.ready_since = Exit(code=1), "x", True, time.monotonic()
    assert process.ready_for >= 0.0
    process.last_beat = process.silent_since = time.monotonic()
    process.numbers = {"/b": 1}
    process.begin()
    assert process.numbers == {"/a": 1, "/b": 2}
    assert process.detail == ""
    assert (process.failed, process.ready_for) == (False, 0.0)
    assert {process.last_beat, process.silent_since} == {None}
    assert process.waiting_for == {"/a", "/b"}
    assert process.rows()[0]["restarts"] == 1


def test_the_state_of_a_lifecycle_node() -> None:
    """Is told of a process that answers; one that does not is unresponsive, whatever its node is in."""
    process = Process("/p", [A], "a.log")
    process.begin()
    process.state, process.lifecycle = State.READY, {"/a": "active"}
    assert process.rows()[0]["lifecycle"] == "active"
    process.silent_since = time.monotonic()
    assert (process.rows()[0]["state"], process.rows()[0]["lifecycle"]) == ("unresponsive", "")
    process.state = State.STOPPING
    assert process.rows()[0]["lifecycle"] == ""


def test_handlers_that_are_put_in_threads() -> None:
    """Beside what the graph file says of the node's groups; a program decides that itself."""
    both = Process("both", [A, B], "both.log")
    both.put_in_threads("/b", ["tick"])
    planned = both.put_in_threads("/b", ["go"])
    assert both.nodes == [A, planned]
    assert planned.concurrency["blocking"].change == GroupChange(("tick", "go"), thread=True)
    with pytest.raises(SupervisorError, match="its own code decides what runs in threads"):
        Process("/p", [PROGRAM], "p.log").put_in_threads("/p", ["tick"])


def test_the_time_that_a_process_may_stay_in_its_state() -> None:
    """One that blocks its event loop, and is started again for that, has little: it cannot clean up."""
    process = Process("both", [A, B], "both.log")
    process.begin()
    process.state = State.RESTARTING
    assert process.may_stay(2.0) == STOP_LIMIT
    process.put_in_threads("/b", ["tick"])
    assert process.may_stay(2.0) == STOP_LIMIT  # it has said nothing yet: it is new
    process.last_beat = 0.0
    assert process.may_stay(1.4) == STOP_LIMIT
    assert process.may_stay(1.6) == BLOCKED_STOP_LIMIT < STOP_LIMIT
    process.state = State.STOPPING
    assert process.may_stay(1.6) == STOP_LIMIT
    process.state, process.delay = State.WAITING, 7.0
    assert process.may_stay(1.6) == 7.0
    process.begin()
    process.state, process.last_beat = State.RESTARTING, 0.0
    assert process.may_stay(1.6) == STOP_LIMIT


def test_the_start_of_a_process_that_is_debugged() -> None:
    """It may take any time: somebody looks for the lines to stop at."""
    debugged = Process("/a", [replace(A, is_debugged=True)], "a.log")
    debugged.state = State.STARTING
    assert debugged.may_stay(0.0) is None
    debugged.state = State.STOPPING
    assert debugged.may_stay(0.0) == STOP_LIMIT
