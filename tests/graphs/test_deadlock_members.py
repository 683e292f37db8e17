"""Members of a ring that leave, die or stand still.

The numbers of rows are those of docs/architecture.md, "What the search must tell apart".
"""

from __future__ import annotations

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
    line_of,
    member,
    reporter,
    reports,
    ring_of,
    wait_for_all,
    wait_for_ring,
)

pytestmark = pytest.mark.real


@slow
def test_a_member_that_is_cancelled(lab: Lab) -> None:
    """The others go on, the report clears, and nothing waits any more (row 18)."""
    up = lab.up(ring_of("ab", "Canceller"))
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    up.wait_for(at("stuck: Canceller"))

    lab.call("/a/give_up")
    wait_for_all(up, [*answered("ab"), "has cleared"])
    assert lab.machine.look("waits") == "nothing is waiting\n"
    assert up.end() == 0
    assert len(reports(up.text)) == 1


@slow
def test_a_member_whose_call_times_out(lab: Lab) -> None:
    """The report says when that will be; then the other is answered, and the report clears (row 19)."""
    up = lab.up({**ring_of("ab"), "/a": member("b", more=", params: {limit: 1.5}")})
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    up.wait_for("times out in 1.")
    wait_for_all(up, ["[a]: CallTimeout: /b/answer did not answer within 1.5 s", *answered("b"), "has cleared"])
    assert up.end() == 0
    assert len(reports(up.text)) == 1
    assert up.text.count("times out in") == 1


@slow
@pytest.mark.parametrize("is_reporter", [True, False])
def test_kill_minus_9_of_a_member(lab: Lab, is_reporter: bool) -> None:
    """Whoever waits for it is told so at once, the others are answered, and no deadlock is left (row 20)."""
    names = "abc"
    up = lab.ring(names)
    wait_for_ring(up, names)
    teller = reporter(up)
    dead = teller if is_reporter else next(name for name in names if name != teller)
    before = "cab"[names.index(dead)]
    [last] = set(names) - {dead, before}

    os.kill(lab.pids()[f"/{dead}"], signal.SIGKILL)
    wait_for_all(up, [f"[{before}]: ServerLost: the server of /{dead}/answer went away", *answered(last)])
    up.wait_for("has cleared")
    assert lab.machine.look("waits") == "nothing is waiting\n"
    told = lab.machine.look("doctor", code=1)
    assert f"/{dead} has failed: signal SIGKILL" in told
    assert "DEADLOCK" not in told
    assert up.end() == 1
    assert len(reports(up.text)) == 1
    assert up.text.count("has cleared") == 1


@slow
def test_a_stopped_process_is_no_member(lab: Lab) -> None:
    """Of one that stands still nothing is claimed; the ring is told when it goes on and closes it (row 21)."""
    up = lab.up(ring_of("ab"))
    wait_for_all(up, at_it("ab"))
    pid = lab.pids()["/b"]
    os.kill(pid, signal.SIGSTOP)
    lab.open_gates("a", "b")
    up.wait_for("[a]: asks")
    told = lab.machine.look("doctor", code=1)
    assert told == f"NODE UNRESPONSIVE: /b (process {pid}) did not answer: it is stopped: kill -CONT {pid}\n"
    up.wait_for(f"NODE UNRESPONSIVE: /b (process {pid}) has not answered for 1.")
    assert "  timer ask of /a, holds 'work': waiting for the response of /b/answer" in lab.machine.look("waits")
    assert reports(up.text) == []

    os.kill(pid, signal.SIGCONT)
    wait_for_all(up, ["[b]: asks", f"/b (process {pid}) answers again"])
    wait_for_ring(up, "ab")
    assert up.end() == 0
    assert len(reports(up.text)) == 1


@slow
def test_a_server_that_is_stopped_while_it_serves(lab: Lab) -> None:
    """Its caller's deadline ends the wait, and nothing is reported, also when it goes on (row 21)."""
    up = lab.up({"/a": member("slow", more=", params: {limit: 1.5}"), "/slow": "class: nodes.ring:Slow"})
    wait_for_all(up, at_it("a"))
    pid = lab.pids()["/slow"]
    lab.open_gates("a")
    up.wait_for("[slow]: serves")
    os.kill(pid, signal.SIGSTOP)
    lab.open_gates("slow")
    up.wait_for("[a]: CallTimeout: /slow/answer did not answer within 1.5 s")

    os.kill(pid, signal.SIGCONT)
    assert lab.machine.look("doctor") == "2 nodes, nothing wrong\n"
    assert up.end() == 0
    assert reports(up.text) == []


def hold(lab: Lab, cls: str) -> Program:
    """Start a graph of which /b holds its event loop while /a waits for its answer."""
    os.mkfifo(lab.root / "nodes" / "pipe")
    up = lab.up({"/a": member("b"), "/b": f"class: nodes.ring:{cls}"})
    wait_for_all(up, at_it("a"))
    lab.open_gates("a")
    up.wait_for("[b]: serves")
    return up


def let_go(lab: Lab) -> None:
    def is_open() -> bool:
        try:
            os.close(os.open(lab.root / "nodes" / "pipe", os.O_WRONLY | os.O_NONBLOCK))
        except OSError:  # nobody reads while a signal's handler runs there
            return False
        return True

    lab.machine.until(is_open, "the pipe is read")


@slow
def test_a_loop_that_is_held(lab: Lab) -> None:
    """The watchdog tells it, with the line; who waits for that process is in no deadlock (row 22)."""
    up = hold(lab, "Sleepy")
    up.wait_for("[graphflow]: the event loop has been blocked for 1.")
    up.wait_for(f"ring.py:{line_of('held: Sleepy')} in hold")

    let_go(lab)
    wait_for_all(up, [*answered("a"), "the event loop runs again after"])
    assert "/b: the event loop was late once, by " in lab.machine.look("doctor")
    assert up.end() == 0
    assert reports(up.text) == []


@slow
def test_the_doctor_sees_a_loop_that_is_held(lab: Lab) -> None:
    """What the log tells, `doctor` tells too."""
    up = hold(lab, "Sleepy")
    up.wait_for("[graphflow]: the event loop has been blocked for 1.")
    assert "/b: the event loop has been blocked for " in lab.machine.look("doctor", code=1)
    let_go(lab)


@slow
def test_an_interpreter_that_is_held(lab: Lab) -> None:
    """A process of which no thread runs is in no deadlock; it is said to be silent, and shows where it is (row 22)."""
    up = hold(lab, "Greedy")
    pid = lab.pids()["/b"]
    told = lab.machine.look("doctor", code=1)
    assert f"NODE UNRESPONSIVE: /b (process {pid}) did not answer: " in told
    assert "DEADLOCK" not in told
    up.wait_for(f"NODE UNRESPONSIVE: /b (process {pid}) has not answered for 1.")
    os.kill(pid, signal.SIGUSR2)
    up.wait_for(f'ring.py", line {line_of("held: Greedy")} in hold')

    let_go(lab)
    wait_for_all(up, [*answered("a"), "nothing in this process could run for "])
    assert lab.machine.look("waits") == "nothing is waiting\n"
    assert up.end() == 0
    assert reports(up.text) == []


@slow
def test_a_ring_through_the_result_of_an_action(lab: Lab) -> None:
    """It is told, and to cancel the goal still ends it (row 26)."""
    nodes = {"/a": "class: nodes.ring:Customer", "/b": "class: nodes.ring:Courier, remap: {position: /a/answer}"}
    up = lab.up(nodes)
    wait_for_all(up, at_it("a"))
    lab.open_gates("a")
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    up.wait_for(f"group 'work' and waits for the result of action /order   {at('stuck: Customer')}toil")
    up.wait_for(f"action deliver of /b waits for the response of service /a/answer   {at('stuck: Courier')}deliver")

    lab.call("/a/give_up")
    wait_for_all(up, ["[a]: cancelled", "has cleared"])
    assert lab.machine.look("waits") == "nothing is waiting\n"
    assert up.end() == 0
    assert len(reports(up.text)) == 1
