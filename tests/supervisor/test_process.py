"""One process of a graph: what `ps` says of it."""

from __future__ import annotations

import time

from graphflow.errors import Place
from graphflow.graph.plan import PlannedNode
from graphflow.machines.process import Exit, State
from graphflow.machines.restarts import Backoff
from graphflow.supervisor.process import Process

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


def test_what_is_wrong_with_it() -> None:
    """How it ended, when it is started again, why it is not, and what is lost of its log."""
    process = Process("/p", [PROGRAM], "p.log")
    process.begin()
    process.state, process.log_error = State.READY, "the disk is full"
    assert process.detail == "its log is not written whole: the disk is full"
    process.state, process.exit, process.failed = State.ENDED, Exit(code=3), True
    assert (process.word, process.detail) == ("failed", "exit code 3")
    process.given_up = "started again 5 times within 30 s"
    assert (process.word, process.detail) == ("given_up", "exit code 3; given up: started again 5 times within 30 s")
    process.state, process.delay, process.since = State.WAITING, 5.0, time.time()
    assert process.word == "waiting"
    assert process.detail.startswith("exit code 3; it is started again in ")


def test_a_new_start_forgets() -> None:
    """What became of the one before; but that there was one is counted."""
    process = Process("both", [A, B], "both.log")
    process.begin()
    process.waiting_for.clear()
    process.exit, process.error, process.failed, process.ready_since = Exit(code=1), "x", True, time.monotonic()
    assert process.ready_for >= 0.0
    process.begin()
    assert process.detail == ""
    assert (process.failed, process.ready_for) == (False, 0.0)
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
