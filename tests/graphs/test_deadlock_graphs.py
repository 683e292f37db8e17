"""The deadlocks of `graphs/deadlock/`: each is explained, and its fix ends it, in memory and in real processes."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from graphflow.graph.resolve import load
from graphflow.supervisor.launching.classes import add_root
from graphflow.supervisor.processes.worker import make_node
from graphflow.testing import Graph
from tests.cases import slow, some
from tests.conftest import PROJECT, Machine
from tests.flat import flat
from tests.graphs.lab import end_at_once

FOLDER = PROJECT / "graphs" / "deadlock"


class Pair(NamedTuple):
    """What a broken graph is told, and what the fixed one says when it works."""

    headline: str
    details: tuple[str, ...]
    works: str


PAIRS = {
    "self_call": Pair(
        "DEADLOCK: timer tick of /narcissus waits for itself",
        (
            "timer tick of /narcissus holds group 'default_group' and waits for the response of service /narcissus/add",
            "(self_call.py:18 in tick, for 0.",
            "/narcissus: {concurrency: {add_group: [add]}}",
        ),
        "1 + 2 = 3",
    ),
    "classic": Pair(
        "DEADLOCK: timer tick of /asker waits for itself",
        (
            "reply add_two_ints of /asker waits for group 'everything' of /asker, which timer tick of /asker holds",
            "let replies through: declare the client of add_two_ints without group=",
        ),
        "1 + 2 = 3",
    ),
    "blocked_loop": Pair(
        "DEADLOCK: timer tick of /blocker waits for itself",
        (
            "timer tick of /blocker blocks the event loop and waits for the response of service /blocker/add",
            "(blocked_loop.py:17 in tick, for 0.",
            "/blocker: {concurrency: {blocking: {handlers: [tick], thread: true}}}",
        ),
        "1 + 2 = 3",
    ),
    "crossing": Pair(
        "DEADLOCK: 2 callbacks wait for each other in a ring",
        (
            "service how_are_you of /left waits for group 'default_group' of /left, which timer greet of /left holds",
            "service how_are_you of /right waits for group 'default_group' of /right, which timer greet of /right",
        ),
        "[left]: the other one says: well",
    ),
    "event": Pair(
        "LIKELY DEADLOCK: action execute of /patient waits for self.time_has_come, and tick, which sets it,",
        (
            "action execute of /patient holds group 'everything' and waits for self.time_has_come   (event.py:26 in",
            "timer tick of /patient sets it and needs group 'everything' of /patient",
        ),
        "after 4 ticks",
    ),
    "recursion": Pair(
        "DEADLOCK: 2 callbacks wait for each other in a ring; 1 more waits for them",
        ("waits for one of the 2 slots of group 'answers'", "/factorial: {concurrency: {answers: {limit: 3}}}"),
        "3! = 6",
    ),
    "goal_on_loop": Pair(
        "LIKELY DEADLOCK: action execute of /turtle1/driver waits for self.x and self.y, and what could end that needs",
        (
            "action execute of /turtle1/driver blocks the event loop and waits for self.x and self.y",
            "await, as in `await self.clock.sleep(0.05)`, in go_to_goal.py:53",
        ),
        "[turtle1.driver]: there",
    ),
    "goal_in_threads": Pair(
        "LIKELY DEADLOCK: action execute of /turtle1/driver waits for self.x and self.y, and located, which sets it,",
        (
            "action execute of /turtle1/driver holds group 'everything' and waits for self.x and self.y",
            "subscription located of /turtle1/driver sets it and needs group 'everything' of /turtle1/driver",
        ),
        "[turtle1.driver]: there",
    ),
    "goal_async": Pair(
        "LIKELY DEADLOCK: action execute of /turtle1/driver waits for self.x and self.y, and located, which sets it,",
        ("(go_to_goal.py:65 in execute", "located_group: [located]}}"),
        "[turtle1.driver]: there",
    ),
    "arrival": Pair(
        "DEADLOCK: 2 callbacks wait for each other in a ring",
        (
            "timer control of /turtle1/follower holds group 'all' and waits for the response of service /turtle1/n",
            "service set_goal of /turtle1/follower waits for group 'all' of /turtle1/follower",
        ),
        "next: (8, 1)",
    ),
}


BLOCKING = ("blocked_loop", "goal_on_loop", "goal_in_threads")
"""What blocks a loop or a thread does so in real time."""
REAL = (*BLOCKING, "self_call", "crossing")
"""Those that run in real processes too, or only."""
LONGEST = 60.0
"""Seconds of a graph's time in which it must have said what is expected."""


async def bring_up(graph: Graph, file: Path) -> None:
    """Start the nodes of a graph file in memory, each as if in a process of its own."""
    plan = load(file)
    add_root(str(PROJECT))
    graph.deadlock = plan.deadlock
    for planned in plan.nodes:
        node = make_node(planned, plan.file)
        await graph.start(node)
        node.context.call_timeout = plan.call_timeout


def said(caplog: pytest.LogCaptureFixture) -> str:
    """The log as the console shows it, without the times."""
    return "\n".join(f"[{r.name.removeprefix('graphflow.node.')}]: {r.getMessage()}" for r in caplog.records)


async def wait_for(graph: Graph, caplog: pytest.LogCaptureFixture, text: str) -> str:
    """Let time pass until something is said; returns all that was."""
    for _ in range(round(LONGEST / 0.05)):
        if flat(text) in (log := flat(said(caplog))):
            return log
        await graph.clock.advance(0.05)
    raise AssertionError(f"no {text!r} in:\n{said(caplog)}")


@pytest.mark.parametrize("name", [name for name in PAIRS if name not in BLOCKING])
async def test_a_broken_graph_is_explained(graph: Graph, caplog: pytest.LogCaptureFixture, name: str) -> None:
    """Who holds what and waits for what, in which line, and what would end it."""
    caplog.set_level("INFO", "graphflow")
    await bring_up(graph, FOLDER / f"{name}_broken.yaml")
    for text in (PAIRS[name].headline, *PAIRS[name].details):
        await wait_for(graph, caplog, text)


@pytest.mark.parametrize("name", [name for name in PAIRS if name not in BLOCKING])
async def test_a_fixed_graph_works(graph: Graph, caplog: pytest.LogCaptureFixture, name: str) -> None:
    """And nothing is reported."""
    caplog.set_level("INFO", "graphflow")
    await bring_up(graph, FOLDER / f"{name}_fixed.yaml")
    log = await wait_for(graph, caplog, PAIRS[name].works)
    assert "DEADLOCK" not in log


@pytest.mark.real
@pytest.mark.parametrize("name", some(REAL, "goal_in_threads"))
def test_a_broken_graph_is_explained_between_processes(machine: Machine, name: str) -> None:
    """The same, by processes that have found it together."""
    pair = PAIRS[name]
    up = machine.start("up", str(FOLDER / f"{name}_broken.yaml"))
    up.wait_for(pair.headline)
    for detail in pair.details:
        up.wait_for(detail)
    end_at_once(up)


@slow
@pytest.mark.real
@pytest.mark.parametrize("name", some(REAL, "crossing"))
def test_a_fixed_graph_works_between_processes(machine: Machine, name: str) -> None:
    """And nothing is reported there either."""
    up = machine.start("up", str(FOLDER / f"{name}_fixed.yaml"))
    up.wait_for(PAIRS[name].works)
    assert "DEADLOCK" not in up.text
    assert up.end() == 0


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "note"),
    [
        ("self_call", "self_call.py:18: CERTAIN: timer tick of /narcissus awaits /narcissus/add"),
        ("crossing", "note: 1 possible deadlock is explained by: graphflow check "),
    ],
)
def test_what_the_source_tells_is_told_at_the_start(machine: Machine, name: str, note: str) -> None:
    """What will not work is said in full, of what may not it is said how to learn more."""
    up = machine.start("up", str(FOLDER / f"{name}_broken.yaml"))
    up.wait_for(note)
    assert up.end() == 0


def test_every_pair_is_here() -> None:
    """A fix is an `include` and an `override`, and nothing else; every file has its counterpart."""
    names = {f.stem.removesuffix("_broken").removesuffix("_fixed") for f in FOLDER.glob("*.yaml")}
    assert names == {*PAIRS, "arrival_race"}
    for name in names:
        fixed = (FOLDER / f"{name}_fixed.yaml").read_text()
        keys = [line.partition(":")[0] for line in fixed.splitlines() if line[:1] not in ("#", " ", "")]
        assert keys == ["include", "override"]
        assert f"include: {name}_broken.yaml" in fixed


@slow
@pytest.mark.real
def test_a_deadlock_is_shown_moved_out_of_and_cleared(machine: Machine) -> None:
    """`waits` and `doctor` show it; `groups move` ends it in the running graph and prints the lines for good."""
    up = machine.start("up", str(FOLDER / "arrival_broken.yaml"))
    up.wait_for("DEADLOCK: 2 callbacks")
    shown = machine.look("waits")
    assert (
        "! timer control of /turtle1/follower, holds 'all': waiting for the response of /turtle1/notify_arrival"
        in shown
    )
    assert "service set_goal of /turtle1/follower is queued for group 'all', held by timer control" in shown
    assert "DEADLOCK: 2 callbacks wait for each other in a ring" in machine.look("doctor", code=1)
    assert "all  (limit 1)\n    set_goal  service  1 runs, 1 waiting" in machine.look("groups", "/turtle1/follower")

    machine.look("groups", "move", "/turtle1/follower", "set_goal", "goals")
    told = machine.look("groups", "move", "/turtle1/follower", "enable", "goals")
    assert "  /turtle1/follower: {concurrency: {" in told
    up.wait_for("the deadlock of")
    up.wait_for("has cleared")
    machine.until(lambda: machine.look("waits") == "nothing is waiting\n", "the waits are over")
    assert "nothing wrong" in machine.look("doctor")
    assert "did you mean 'enable'?" in machine.look("groups", "move", "/turtle1/follower", "enabl", "x", code=2)
    assert up.end() == 0


@slow
@pytest.mark.real
def test_a_larger_limit_ends_a_deadlock(machine: Machine) -> None:
    """`groups limit` sets it in the running node; what is no limit, or no group, is refused by name."""
    up = machine.start("up", str(FOLDER / "classic_broken.yaml"))
    up.wait_for("DEADLOCK: timer tick of /asker")
    told = machine.look("groups", "limit", "/asker", "everything", "2")
    assert "everything  (limit 2)" in told
    assert "  /asker: {concurrency: {everything: {limit: 2}}}" in told
    up.wait_for("has cleared")
    assert "'0' is not a limit" in machine.look("groups", "limit", "/asker", "everything", "0", code=2)
    assert "did you mean 'everything'?" in machine.look("groups", "limit", "/asker", "everythin", "3", code=2)
    assert up.end() == 0


@slow
@pytest.mark.real
def test_a_handler_is_put_in_a_thread(machine: Machine) -> None:
    """`groups thread` starts the node again, whose loop is blocked, and then it runs."""
    up = machine.start("up", str(FOLDER / "blocked_loop_broken.yaml"))
    up.wait_for("DEADLOCK: timer tick of /blocker")
    assert "has no handler 'tock'; did you mean 'tick'?" in machine.look("groups", "thread", "/blocker", "tock", code=2)
    assert "add of /blocker is async" in machine.look("groups", "thread", "/blocker", "add", code=2)
    assert "did you mean 'thread'?" in machine.look("groups", "thrad", "/blocker", "tick", code=2).lower()
    assert "/blocker is running again" in machine.look("groups", "thread", "/blocker", "tick")
    up.wait_for("1 + 2 = 3")
    assert "blocking  (limit 1, in threads)\n    tick  timer" in machine.look("groups", "/blocker")
    assert up.end() == 0
