"""Rings of real processes that wait for each other over Zenoh: what is told of them, once, and what ends them.

The numbers of rows are those of docs/architecture.md, "What the search must tell apart".
"""

from __future__ import annotations

import logging
import os
import signal

import pytest

from tests.cases import slow
from tests.conftest import Program
from tests.graphs.lab import (
    Lab,
    answered,
    at,
    at_it,
    echo_of,
    end_at_once,
    member,
    reports,
    ring_of,
    seconds_to_report,
    wait_for_all,
    wait_for_ring,
    zids,
)

pytestmark = pytest.mark.real

logger = logging.getLogger(__name__)


@pytest.mark.parametrize(("names", "policy"), [("ab", "raise"), pytest.param("abc", "report", marks=slow)])
def test_a_ring_of_processes(lab: Lab, names: str, policy: str) -> None:
    """One of them reports it, no call is failed for it, and moving a handler lets all go on (rows 3, 4, 6, 29)."""
    up = lab.ring(names, policy=policy)
    wait_for_ring(up, names)
    logger.info("%s: told after %.3f s", names, seconds_to_report(up.text))

    told = lab.machine.look("groups", "move", "/a", "answer", "answer_group")
    assert "  /a: {concurrency: {answer_group: [answer]}}" in told
    wait_for_all(up, [*answered(names), "has cleared"])
    assert up.end() == 0
    assert len(reports(up.text)) == 1
    assert up.text.count("has cleared") == 1
    assert "DeadlockError" not in up.text


@slow
def test_members_that_answer_in_a_group_of_its_own(lab: Lab) -> None:
    """The same calls are answered, and nothing is reported (row 4)."""
    nodes = {name: f"{about}, concurrency: {{answers: [answer]}}" for name, about in ring_of("ab").items()}
    up = lab.up(nodes)
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    wait_for_all(up, answered("ab"))
    assert up.end() == 0
    assert reports(up.text) == []


@slow
def test_a_ring_that_is_closed_late(lab: Lab) -> None:
    """However long its members have waited, it is told soon after the last one has begun to."""
    up = lab.up(ring_of("abc"))
    wait_for_all(up, at_it("abc"))
    first = min("abc", key=zids(up).__getitem__)
    closing = "abca"["abc".index(first) + 1]
    lab.open_gates(*{"a", "b", "c"} - {closing})
    up.wait_for(f"[{first}]: asks")
    # Meanwhile it looks at its wait after 0.25, 0.5, 1 and 2 s; the next look would be after 4 s.
    with pytest.raises(AssertionError, match=r"within 2\.2 s"):
        up.wait_for("DEADLOCK", limit=2.2)

    lab.open_gates(closing)
    up.wait_for("DEADLOCK: 3 callbacks wait for each other in a ring")
    up.wait_for(f"[{closing}]: asks")
    assert seconds_to_report(up.text) < 1.0


@slow
def test_a_chain_that_comes_back_to_its_caller(lab: Lab) -> None:
    """The innermost call fails at once, and its error travels back through the other process (row 5)."""
    up = lab.up({"/a": member("b"), "/b": echo_of("a")}, policy="raise")
    wait_for_all(up, at_it("a"))
    lab.pids()  # takes a while, in which the lines open: a server that is not known to be graphflow's gets no chain
    lab.open_gates("a")
    up.wait_for("[b]: DEADLOCK: timer ask of /a waits for itself")
    up.wait_for(f"waits for the response of service /b/answer   {at('stuck: Member')}toil")
    assert up.end() == 0
    assert reports(up.text) == []


@slow
def test_a_chain_that_comes_back_to_its_caller_is_reported(lab: Lab) -> None:
    """Where nothing is raised, the lines of both processes are told (row 5)."""
    up = lab.up({"/a": member("b"), "/b": echo_of("a")})
    wait_for_all(up, at_it("a"))
    lab.open_gates("a")
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    up.wait_for(f"service answer of /b waits for the response of service /a/answer   {at('stuck: Echo')}answer")
    up.wait_for(f"holds group 'work' and waits for the response of service /b/answer   {at('stuck: Member')}toil")
    assert up.end() == 0
    assert len(reports(up.text)) == 1


@slow
def test_what_takes_long_lives(lab: Lab) -> None:
    """Two who queue for a server that is busy are looked at, and not reported (row 9)."""
    up = lab.up({"/a": member("slow"), "/b": member("slow"), "/slow": "class: nodes.ring:Slow"})
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    wait_for_all(up, ["[slow]: serves", "[a]: asks", "[b]: asks"])
    shown = lab.machine.look("waits")
    assert "  timer ask of /a, holds 'work': waiting for the response of /slow/answer" in shown
    assert "!" not in shown
    assert lab.machine.look("doctor") == "3 nodes, nothing wrong\n"

    lab.open_gates("slow")
    wait_for_all(up, answered("ab"))
    assert up.end() == 0
    assert reports(up.text) == []


@slow
def test_a_call_that_blocks_the_loop_it_needs(lab: Lab) -> None:
    """It is told, shown and found by the blocked process itself; a thread of its own ends it (row 17)."""
    up = lab.up({"/a": member("b", "Blocker"), "/b": echo_of("a")})
    up.wait_for("DEADLOCK: timer ask of /a waits for itself")
    up.wait_for("timer ask of /a blocks the event loop and waits for the response of service /b/answer   (ring.py:")
    up.wait_for(f"{at('stuck: Blocker')}ask, for ")
    up.wait_for(line := "/a: {concurrency: {blocking: {handlers: [ask], thread: true}}}")
    assert "! timer ask of /a: waiting for the response of /b/answer" in lab.machine.look("waits")
    told = lab.machine.look("groups", "move", "/a", "answer", "answers", "--timeout", "0.2", code=4)
    assert "its event loop may be blocked" in told
    end_at_once(up)

    fixed = lab.up_fixed(f"  {line}")
    fixed.wait_for("[a]: was answered")
    assert fixed.end() == 0
    assert reports(fixed.text) == []


@slow
def test_a_call_that_blocks_the_loop_it_needs_is_one_report(lab: Lab) -> None:
    """It is told once, though the other process finds it, too (rows 17, 29)."""
    up = lab.up({"/a": member("b", "Blocker"), "/b": echo_of("a")})
    up.wait_for("DEADLOCK: ")
    up.wait_for("[graphflow]: the event loop has been blocked for 1.")
    assert "DEADLOCK: " in lab.machine.look("doctor", code=1)
    end_at_once(up)
    assert len(reports(up.text)) == 1


def close_and_open(lab: Lab, programs: list[Program]) -> None:
    """Close a ring of /a and /b, each of a program of its own; it is reported once, and a moved handler ends it."""
    for program, name in zip(programs, "ab", strict=True):
        wait_for_all(program, at_it(name))
    lab.open_gates("a", "b")
    lab.machine.until(lambda: "DEADLOCK" in lab.machine.look("doctor", code=None), "it is found")
    lab.machine.look("groups", "move", "/b", "answer", "answers")
    for program, name in zip(programs, "ab", strict=True):
        wait_for_all(program, answered(name))
    for program in programs:  # one that ends earlier begins no answer to the other any more
        assert program.end() == 0
    assert len(reports(*(program.text for program in programs))) == 1


@slow
def test_two_supervisors_are_one_report(lab: Lab) -> None:
    """A ring through two graphs, each of a terminal of its own, is told once (row 29)."""
    files = [lab.write({node: about}, name=f"lab_{node[1:]}") for node, about in ring_of("ab").items()]
    close_and_open(lab, [lab.machine.start("up", file, cwd=lab.root) for file in files])


@slow
def test_no_supervisor_is_needed(lab: Lab) -> None:
    """So is one of nodes that were started by hand (row 29)."""
    words = ["run", "nodes.ring:Member", "--ros-args"]
    names = [("a", "b"), ("b", "a")]
    remaps = [["-r", f"__node:={name}", "-r", f"following:=/{other}/answer"] for name, other in names]
    close_and_open(lab, [lab.machine.start(*words, *remap, cwd=lab.root) for remap in remaps])


@slow
def test_one_who_asks_two_is_one_report(lab: Lab) -> None:
    """One asks two others at once, who both ask back: that is told once, also if the pictures differ in age (row 29).

    They do by half a second: so long everybody waits for a process that stands still.
    """
    up = lab.up(ring_of("abc", "Boss") | {"/idle": "class: nodes.ring:Slow"})
    wait_for_all(up, at_it("abc"))
    os.kill(lab.pids()["/idle"], signal.SIGSTOP)
    boss = max("abc", key=zids(up).__getitem__)
    lab.open_gates(boss)
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    assert "DEADLOCK: " in lab.machine.look("doctor", code=1)
    end_at_once(up)
    assert len(reports(up.text)) == 1
