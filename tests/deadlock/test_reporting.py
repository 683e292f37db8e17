"""The reporter: one explanation per deadlock, by one process, and a message at its end."""

from __future__ import annotations

import asyncio
from dataclasses import replace

from graphflow.deadlock import reporting
from graphflow.deadlock.reporting import PROBE_AFTER, Reporter, is_old, lines_of
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, explained
from graphflow.machines.waits.wait_graph import FREE, WaitGraph
from graphflow.wire.liveliness import Entity, Kind
from tests.deadlock.cast import Caplog
from tests.deadlock.stage import Stage
from tests.machines.pictures import call, circle, group, picture, queue, run


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


async def test_a_loop_seen_at_another_line(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """A likely deadlock stands while its members run: its end is reported once it stays out of sight."""
    stage = Stage()
    reporter, here = Reporter(stage, "report"), {stage.session.zid}
    graph, deadlock = ring_of(stage, own=2, other="")
    elsewhere = WaitGraph({name: run(name) for name in deadlock.ring})
    reporter.report(replace(deadlock, is_likely=True), graph)
    for _ in range(2):
        reporter.take_back(elsewhere, set(), here)
        assert reporter.looks_again_in == PROBE_AFTER
        await stage.clock.advance(0.2)
        reporter.take_back(graph, deadlocked(graph), here)
        assert reporter.looks_again_in is None
    assert len(caplog.messages) == len(reporter.reports) == 1
    reporter.take_back(elsewhere, set(), here)
    await stage.clock.advance(0.25)
    reporter.take_back(elsewhere, set(), here)
    assert caplog.messages[1:] == ["the deadlock of timer tick0 of /node and timer tick1 of /node has cleared"]
    assert reporter.looks_again_in is None


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


async def test_the_reporter_does_not_answer(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """Without its waits, another ring through a member of its deadlock is no new one; once it has gone, it is."""
    stage = Stage()
    reporter, mine = Reporter(stage, "report"), stage.session.zid
    server = Entity(0, "0abc", 0, 1, Kind.SERVICE, "/", "other", "/answer", "std_srvs/srv/Empty", "x")
    stage.cache.apply(server.token, alive=True)
    graph, deadlock = ring_of(stage, own=1, other="0abc")
    reporter.report(deadlock, graph)
    caplog.clear()
    left = reporter.left_to_silent({mine})
    assert left == {frozenset({"tick0", "tick1"}): "0abc"}

    without = picture(
        replace(run("tick0", call("to9"), holds="g0"), process=mine, age=1.0),
        replace(run("tick9", call("to0"), holds="g9"), process=mine, age=1.0),
        group("g0"),
        group("g9"),
        queue("service0", "g0", "to0"),
        queue("service9", "g9", "to9"),
    )
    [another] = explained(without, deadlocked(without))
    reporter.report(another, without, left)
    assert caplog.messages == ["timer tick9 of /node waits behind the deadlock of timer tick0 of /node"]
    caplog.clear()

    stage.cache.apply(server.token, alive=False)
    assert reporter.left_to_silent({mine}) == {}
    reporter.report(another, without)
    assert caplog.messages[0].startswith("DEADLOCK: 2 callbacks wait for each other in a ring")


async def test_the_reporter_answers(graphflow_runner: asyncio.Runner) -> None:
    """Its reports are known from its answer alone."""
    stage = Stage()
    reporter = Reporter(stage, "report")
    server = Entity(0, "0abc", 0, 1, Kind.SERVICE, "/", "other", "/answer", "std_srvs/srv/Empty", "x")
    stage.cache.apply(server.token, alive=True)
    graph, deadlock = ring_of(stage, own=1, other="0abc")
    reporter.report(deadlock, graph)
    assert reporter.left_to_silent({stage.session.zid, "0abc"}) == {}
    assert reporter.left_to_silent({stage.session.zid}) == {}


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
