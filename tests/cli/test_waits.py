"""`graphflow waits`, `groups` and `doctor`, before, during and after a deadlock between processes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.conftest import Machine
from tests.graphs.lab import Lab, at_it, line_of, reports, ring_of, wait_for_all, wait_for_ring

pytestmark = pytest.mark.real


@pytest.fixture
def lab(machine: Machine, tmp_path: Path) -> Lab:
    """A project with nodes that can wait for each other."""
    return Lab(machine, tmp_path / "lab")


def test_exit_codes_and_what_is_shown(lab: Lab) -> None:
    """Before, during and after a deadlock, and when nothing runs."""
    run = lab.machine.run
    up = lab.up(ring_of("ab"))
    wait_for_all(up, at_it("ab"))
    assert run("doctor") == "2 nodes, nothing wrong\n"
    assert "timer ask of /a, holds 'work': runs" in run("waits")

    lab.open_gates("a", "b")
    wait_for_ring(up, "ab")
    shown = run("waits")
    for name, other in ("ab", "ba"):
        assert f"! timer ask of /{name}, holds 'work': waits for the answer of /{other}/answer since " in shown
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
    assert run("waits") == "nobody waits\n"
    assert run("doctor") == "2 nodes, nothing wrong\n"
    assert up.end() == 0


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ("waits", 3, "error: nothing is running"),
        ("doctor --json", 3, "error: nothing is running"),
        ("groups move /a answer answers", 3, "error: nothing is running"),
        ("doctor now", 2, "unexpected extra argument"),
    ],
)
def test_nothing_runs(machine: Machine, words: str, code: int, told: str) -> None:
    """Exit code 3, or 2 when the words are wrong anyway."""
    assert told in machine.look(*words.split(), code=code)
