"""Decisions on the end of a process that is not restarted."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.graph.plan import PlannedNode
from graphflow.machines.process import Exit, Need, Order, State
from graphflow.supervisor.ends import GraphEnd, end_of_graph, has_failed, was_stopped
from graphflow.supervisor.processes.process import Process

HERE = Place("g.yaml", 1)
NOTHING = Order({})
WAITED_FOR = Order({"/b": frozenset({Need("/a", "done")})})


def ended(code: int, **planned: Any) -> Process:
    process = Process("/a", [PlannedNode("/a", "n:A", HERE, HERE, **planned)], "a.log")
    process.exit = Exit.of_status(code)
    process.failed = code != 0
    return process


@pytest.mark.parametrize(
    ("was", "code", "failed"),
    [
        (State.READY, 0, False),
        (State.READY, 3, True),
        (State.STARTING, 0, True),
        (State.STOPPING, 3, False),
        (State.WAITING, 3, False),
    ],
)
def test_a_failure(was: State, code: int, failed: bool) -> None:
    """A process fails by its exit code, or by ending before it was ready; never by request."""
    assert has_failed(ended(code), was) is failed


def test_a_requested_end() -> None:
    """A request counts in any state."""
    process = ended(-15)
    assert not was_stopped(process, State.READY)
    process.stop_requested = True
    assert was_stopped(process, State.READY)


@pytest.mark.parametrize(
    ("process", "was", "order", "end"),
    [
        (ended(0), State.STARTING, NOTHING, None),
        (ended(3), State.READY, NOTHING, None),
        (ended(3, critical=True), State.READY, NOTHING, GraphEnd("/a is critical, and has failed", True)),
        (ended(0, critical=True), State.READY, NOTHING, None),
        (ended(0, on_exit="shutdown"), State.READY, NOTHING, GraphEnd("/a has ended", False)),
        (ended(0), State.READY, WAITED_FOR, None),
        (ended(3), State.READY, WAITED_FOR, GraphEnd("/b waits until /a is done, and that has failed", True)),
    ],
)
def test_the_end_of_a_graph_that_is_up(process: Process, was: State, order: Order, end: GraphEnd | None) -> None:
    """It ends with a critical process, one that ends it, or one whose success another waits for."""
    assert end_of_graph(process, was, order, is_up=True) == end


def test_the_end_of_a_graph_that_comes_up() -> None:
    """It cannot come up without a process that did not start."""
    assert end_of_graph(ended(0), State.STARTING, NOTHING, is_up=False) == GraphEnd("/a did not start", True)
