"""`graphflow waits`, `groups` and `doctor`, before, during and after a deadlock between processes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.cases import slow
from tests.conftest import Machine
from tests.graphs.lab import Lab, at_it, line_of, reports, ring_of, wait_for_all, wait_for_ring

pytestmark = pytest.mark.real


@pytest.fixture
def lab(machine: Machine, tmp_path: Path) -> Lab:
    """A project with nodes that can wait for each other."""
    return Lab(machine, tmp_path / "lab")


@slow
def test_exit_codes_and_what_is_shown(lab: Lab) -> None:
    """Before, during and after a deadlock, and when nothing runs."""
    run = lab.machine.run
    up = lab.up(ring_of("ab"))
    wait_for_all(up, at_it("ab"))
    assert run("doctor") == "2 nodes, nothing wrong\n"
    assert "timer ask of /a, holds 'work': running" in run("waits")

    lab.open_gates("a", "b")
    wait_for_ring(up, "ab")
    shown = run("waits")
    for name, other in ("ab", "ba"):
        assert f"! timer ask of /{name}, holds 'work': waiting for the response of /{other}/answer, " in shown
        assert f"service answer of /{name} is queued for group 'work', held by timer ask of /{name}: 1 wait" in shown
    assert shown.count(f"ring.py:{line_of('stuck: Member')} in toil") == 4  # two waits, and two in the report
    assert "DEADLOCK: 2 callbacks wait for each other in a ring" in shown
    assert "nothing wrong" not in run("doctor", code=1)
    found = json.loads(run("doctor", "--json", code=1))
    assert [text.splitlines()[0] for text in found["deadlocks"]] == reports(up.text)
    stuck = [row["activity"] for row in json.loads(run("waits", "--json"))["activities"] if row["stuck"]]
    assert sorted(stuck) == ["timer ask of /a", "timer ask of /b"]

    run("groups", "move", "/b", "answer", "answers")
    up.wait_for("has cleared")
    assert run("waits") == "nothing is waiting\n"
    assert run("doctor") == "2 nodes, nothing wrong\n"
    assert up.end() == 0


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ("waits", 3, "error: nothing is running"),
        ("doctor --json", 3, "error: nothing is running"),
        ("groups move /a answer answers", 3, "error: nothing is running"),
    ],
)
def test_nothing_runs(machine: Machine, words: str, code: int, told: str) -> None:
    """The exit code is 3, or 2 for wrong usage."""
    assert told in machine.look(*words.split(), code=code)


def test_a_graph_in_which_nobody_waits(standing: Machine) -> None:
    """The text says so, and all lists of the JSON are empty; on a busy machine, a message may be queued."""
    standing.until(lambda: standing.look("waits") == "nothing is waiting\n", "nobody waits")
    nothing: dict[str, Any] = {"activities": [], "queued": [], "deadlocks": [], "stalls": [], "unresponsive": []}
    standing.until(lambda: json.loads(standing.look("waits", "--json")) == nothing, "nor for programs")


def test_the_groups_of_a_node(standing: Machine) -> None:
    """Each with its limit and its handlers, and then those in no group; or the same for programs."""
    lines = standing.look("groups", "/office/clerk").splitlines()
    assert lines[:2] == ["/office/clerk", "  desk  (limit 1)"]
    assert lines[2].startswith("    add  service  ")
    assert lines[3] == "  in no group  (each waits only for its own runs)"
    assert "    add_in_secret  service  0 runs" in lines[4:]
    found = json.loads(standing.look("groups", "/office/clerk", "--json"))
    assert found["node"] == "/office/clerk"
    assert [h["handler"] for g in found["groups"] if g["name"] == "desk" for h in g["handlers"]] == ["add"]


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ("groups /office/clrk", 1, "there is no node /office/clrk; did you mean '/office/clerk'?"),
        ("groups move /office/clrk add x", 1, "there is no node /office/clrk; did you mean '/office/clerk'?"),
        ("groups move /office/clerk ad x", 2, "did you mean 'add'?"),
        ("groups move /office/clerk add", 2, "Missing argument 'HANDLER...'"),
    ],
)
def test_words_that_do_not_fit_the_graph(standing: Machine, words: str, code: int, told: str) -> None:
    """The error suggests existing names, and nothing is moved."""
    assert told in standing.look(*words.split(), code=code)
    assert "  desk  (limit 1)\n    add  service  " in standing.look("groups", "/office/clerk")
