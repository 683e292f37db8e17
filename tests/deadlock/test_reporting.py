"""The reporter: one explanation per deadlock, by one process, and a message at its end."""

from __future__ import annotations

import asyncio
from dataclasses import replace

from graphflow.deadlock import reporting
from graphflow.deadlock.reporting import Reporter, is_old, lines_of
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, explained
from graphflow.machines.waits.wait_graph import FREE, WaitGraph
from tests.deadlock.cast import Caplog
from tests.deadlock.stage import Stage
from tests.machines.pictures import circle, run


def ring_of(stage: Stage, *, own: int, other: str) -> tuple[WaitGraph, Deadlock]:
    """A deadlock of two timers, some of which are in another process."""
    graph = circle(2)
    places = [stage.session.zid if i < own else other for i in range(2)]
    activities = {f"tick{i}": replace(graph.activities[f"tick{i}"], process=places[i], age=1.0) for i in range(2)}
    graph = replace(graph, activities=activities)
    [deadlock] = explained(graph, deadlocked(graph))
    return graph, deadlock


async def test_a_deadlock_is_explained_once(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """Its report stands until the ring is gone, and the end is reported."""
    stage = Stage()
    reporter = Reporter(stage, "report")
    graph, deadlock = ring_of(stage, own=2, other="")
    reporter.report(deadlock, graph)
    reporter.report(deadlock, graph)

    [text] = caplog.messages
    assert text.startswith("DEADLOCK: 2 callbacks wait for each other in a ring\n")
    assert list(reporter.reports) == [frozenset({"tick0", "tick1"})]
    assert reporter.is_known(frozenset({"tick1", "tick7"}))
    assert reporter.has_reported("tick1", "")
    assert not reporter.has_reported("tick7", "timer tick7 of /node")

    reporter.take_back(WaitGraph({"tick0": run("tick0")}), set(), {stage.session.zid})
    assert caplog.messages[1:] == ["the deadlock of timer tick0 of /node and timer tick1 of /node has cleared"]
    assert reporter.reports == {}


async def test_the_same_again_takes_a_line(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """When a deadlock of the same members and lines comes back."""
    stage = Stage()
    reporter = Reporter(stage, "report")
    graph, deadlock = ring_of(stage, own=2, other="")
    reporter.report(deadlock, graph)
    reporter.take_back(WaitGraph(), set(), {stage.session.zid})
    reporter.report(deadlock, graph)

    assert caplog.messages[2:] == [
        "DEADLOCK again (2 times so far): 2 callbacks wait for each other in a ring",
    ]


async def test_the_lowest_id_reports(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """Any other process says, once, where to read it."""
    stage = Stage()
    reporter = Reporter(stage, "report")
    graph, deadlock = ring_of(stage, own=1, other="")
    reporter.report(deadlock, graph)
    reporter.report(deadlock, graph)

    [text] = caplog.messages
    assert " waits in a deadlock: the log of /node explains it, and says when it is over" in text
    assert reporter.reports == {}
    [foreign] = reporter.foreign.values()
    assert (foreign.reporter, foreign.processes) == ("", {"", stage.session.zid})


async def test_a_foreign_deadlock_is_forgotten_late(graphflow_runner: asyncio.Runner) -> None:
    """Its reporter may be exiting, and its waits here end before its tokens do."""
    stage = Stage()
    reporter = Reporter(stage, "report")
    graph, deadlock = ring_of(stage, own=1, other="")
    reporter.report(deadlock, graph)
    reporter.forget_foreign(graph)
    over = replace(graph, activities={"tick0": replace(graph.activities["tick0"], wait=FREE)})
    reporter.forget_foreign(over)
    assert reporter.foreign
    await stage.clock.advance(reporting.FORGET_AFTER)
    reporter.forget_foreign(over)
    assert reporter.foreign == {}


async def test_the_history_is_bounded(graphflow_runner: asyncio.Runner) -> None:
    """The entry that is longest unused goes first."""
    reporter = Reporter(Stage(), "report")
    reporter.count("kept")
    for number in range(reporting.HISTORY_BOUND - 1):
        reporter.count(number)
    assert reporter.count("kept") == 2
    reporter.count("new")
    assert reporter.count("kept") == 3
    assert reporter.count(0) == 1


def test_members_and_ages() -> None:
    """A deadlock is recognized by its members and their lines; a wait is old after a quarter of a second."""
    assert lines_of([run("a"), run("b")]) == lines_of([run("b"), run("a")])
    assert [is_old(run("a", age=age)) for age in (0.2, 0.25)] == [False, True]
