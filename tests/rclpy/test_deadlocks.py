"""Deadlocks of code written for rclpy, in processes of their own, and with nodes of graphflow's."""

from __future__ import annotations

import os
import select
import time
from pathlib import Path

import pytest

from tests.cases import slow, some
from tests.conftest import Machine, Program
from tests.flat import flat

pytestmark = [pytest.mark.real, pytest.mark.timeout(60)]

LIMIT = 20.0
PROGRAMS = Path(__file__).parents[1] / "programs/rclpy"


def line(file: str, mark: str) -> str:
    """`ring.py:41`, the line that is marked with a comment."""
    lines = (PROGRAMS / file).read_text("utf-8").splitlines()
    return f"{file}:{next(n for n, text in enumerate(lines, 1) if text.endswith(f'# {mark}'))} in "


def ring(machine: Machine, *members: str) -> list[Program]:
    """Members of a ring, the first started last."""
    found: list[Program] = []
    for words in reversed(members):
        found.insert(0, machine.start("run", "ring.py", *words.split(), cwd=PROGRAMS))
        found[0].wait_for("up")
    return found


def told(programs: list[Program], *marks: str) -> None:
    """One report, by whichever process, with each of these lines in it, and none more."""
    until = time.monotonic() + LIMIT
    while not any("ends it:" in program.text for program in programs):
        assert time.monotonic() < until, [program.text for program in programs]
        read(programs)
    for _ in range(10):
        read(programs)
    reports = [flat(program.text) for program in programs if "DEADLOCK:" in program.text]
    assert [report.count("DEADLOCK:") for report in reports] == [1], reports
    for mark in marks:
        assert mark in reports[0], reports[0]


def read(programs: list[Program], seconds: float = 0.1) -> None:
    """Read what programs have said."""
    outs = {program.process.stdout.fileno(): program for program in programs if program.process.stdout is not None}
    for out in select.select(list(outs), [], [], seconds)[0]:
        outs[out].text += os.read(out, 65536).decode(errors="replace")


RINGS = [
    ("calls", "timer", "ask", "with callback_group=MutuallyExclusiveCallbackGroup() each"),
    ("awaits", "async timer", "async ask", "ReentrantCallbackGroup()"),
    ("pools", "timer", "ask", "with callback_group=MutuallyExclusiveCallbackGroup() each"),
    ("acts", "goal", "act", "future = client.send_goal_async(goal)"),
]


@slow
@pytest.mark.parametrize("case", some(RINGS, RINGS[0]), ids=lambda case: case[0])
def test_two_processes_wait_for_each_other(machine: Machine, case: tuple[str, str, str, str]) -> None:
    """One of them tells it, with the lines of both."""
    how, one, other, remedy = case
    programs = ring(machine, f"a b {how} starts", f"b a {how}")
    told(programs, line("ring.py", one), remedy)
    # A goal's answer needs what the timer holds, so that the timer also waits for itself; either is told first.
    report = flat("".join(program.text for program in programs))
    assert line("ring.py", other) in report or (how == "acts" and "waits for itself" in report)


@slow
def test_three_processes_wait_for_each_other(machine: Machine) -> None:
    """In a ring."""
    members = ring(machine, "a b calls starts", "b c calls", "c a calls")
    told(members, line("ring.py", "timer"), line("ring.py", "ask"), "3 callbacks")


@slow
def test_a_ring_with_a_node_of_graphflows(machine: Machine) -> None:
    """Each part in its own words."""
    native = machine.start("run", "native.py", cwd=PROGRAMS)
    [first] = ring(machine, "a b calls starts")
    told(
        [native, first],
        line("ring.py", "timer"),
        line("native.py", "native ask"),
        "make on_timer of /a with callback_group=",
    )


REMEDIES = [
    *(("later", "ab"), ("later", "abc"), ("apart", "ab"), ("apart", "abc"), ("goals", "ab")),
    ("later beside graphflow's", "a"),
]


@slow
@pytest.mark.parametrize("case", some(REMEDIES, REMEDIES[2]), ids="-".join)
def test_the_remedy_of_a_ring_ends_it(machine: Machine, case: tuple[str, str]) -> None:
    """Nobody blocks, or nobody holds what another needs; it goes all the way round, and nothing is told."""
    how, names = case
    members = [f"{name} {names[(i + 1) % len(names)]} {how}" for i, name in enumerate(names)]
    programs = []
    if "beside" in how:
        programs, members = [machine.start("run", "native.py", cwd=PROGRAMS)], ["a b later"]
    programs = [*ring(machine, f"{members[0]} starts", *members[1:]), *programs]
    programs[0].wait_for("all the way round")
    read(programs, 1.0)
    assert "DEADLOCK" not in "".join(program.text for program in programs)


NOBODY = [("calls", "spin_until_future_complete"), ("polls", "spin_until_future_complete"), ("sleeps", "target=")]


@slow
@pytest.mark.parametrize("case", some(NOBODY, NOBODY[0]), ids=lambda case: case[0])
def test_nobody_spins(machine: Machine, case: tuple[str, str]) -> None:
    """The main thread waits for what only it, or another thread, could bring about by spinning."""
    how, remedy = case
    told([machine.start("run", "nobody.py", how, cwd=PROGRAMS)], line("nobody.py", how), remedy)


@pytest.mark.parametrize("how", some(["after", "later", "spins"], "after"))
def test_somebody_spins_in_the_end(machine: Machine, how: str) -> None:
    """Nothing is told while another thread may still begin to."""
    program = machine.start("run", "nobody.py", how, cwd=PROGRAMS)
    program.wait_for("done")
    assert "DEADLOCK" not in program.text
    program.end()
