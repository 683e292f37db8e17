"""Whether the nodes answer."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from graphflow.errors import Place
from graphflow.graph.plan import PlannedNode
from graphflow.machines.process import State
from graphflow.supervisor.processes import health, process_tree
from graphflow.supervisor.processes.health import CHECK_EVERY, SILENCE, Health
from graphflow.supervisor.processes.process import Process
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.running import GOOD, rows, write

HERE = Place("g.yaml", 1, 1)


class Ward:
    """A process that speaks when a test wants it to, and looks at it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.process = Process("/a", [PlannedNode("/a", "x:A", HERE, HERE)], "a.log")
        self.process.begin()
        self.process.state = State.READY
        self.told: list[str] = []
        self.now = 100.0
        monkeypatch.setattr(health, "_why", lambda process: "it is blocked")
        self.health = Health([self.process], self.told.append)
        self.health.check(self.now)

    def looks(self, seconds: float, *, speaks: bool) -> None:
        for _ in range(round(seconds / CHECK_EVERY)):
            self.now += CHECK_EVERY
            if speaks:
                self.process.last_beat = self.now
            self.health.check(self.now)


def test_silence_and_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both are told, once each."""
    ward = Ward(monkeypatch)
    ward.looks(3.0, speaks=True)
    ward.looks(SILENCE, speaks=False)
    assert (ward.told, ward.process.state_name) == ([], "ready")
    ward.looks(5.0, speaks=False)
    assert ward.told == ["/a has not answered for 4 s: it is blocked"]
    assert ward.process.state_name == "unresponsive"
    assert ward.process.detail.startswith("its event loop has not answered for ")
    ward.looks(1.0, speaks=True)
    assert ward.told[1:] == ["/a answers again, after 8 s"]
    assert (ward.process.state_name, ward.process.detail) == ("ready", "")


def test_who_need_not_speak(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that never sent a beat, such as a foreign program, and one that is starting or being stopped."""
    ward = Ward(monkeypatch)
    ward.looks(10.0, speaks=False)
    ward.looks(1.0, speaks=True)
    ward.process.state = State.STOPPING
    ward.looks(10.0, speaks=False)
    assert ward.told == []


def test_a_supervisor_that_was_held_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """It has heard nobody meanwhile; what has been said comes after."""
    ward = Ward(monkeypatch)
    ward.looks(1.0, speaks=True)
    ward.now += 60.0
    ward.health.check(ward.now)
    assert ward.told == []
    ward.looks(1.0, speaks=True)
    assert ward.told == []


@slow
@pytest.mark.real
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="processes cannot be stopped there")
def test_a_node_that_is_stopped(machine: Machine, project: Path) -> None:
    """`ps` shows it, the terminal says what to do, and when it goes on all is well."""
    up = machine.start("up", write(project, GOOD), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    pid = rows(machine)["/a"]["pid"]
    os.kill(pid, signal.SIGSTOP)
    up.wait_for(f"process {pid} is stopped; to let it go on: kill -CONT {pid}")
    assert {name: row["state"] for name, row in rows(machine).items()} == {"/a": "unresponsive", "/b": "ready"}
    os.kill(pid, signal.SIGCONT)
    up.wait_for("/a answers again, after ")
    assert rows(machine)["/a"]["state"] == "ready"
    up.process.send_signal(signal.SIGINT)
    assert up.wait() == 0


def test_who_is_debugged_may_be_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    """For as long as it stands at a breakpoint."""
    ward = Ward(monkeypatch)
    ward.process.is_debugged = True
    ward.looks(1.0, speaks=True)
    ward.looks(10 * SILENCE, speaks=False)
    assert (ward.told, ward.process.state_name) == ([], "ready")


@pytest.mark.skipif(not hasattr(signal, "SIGUSR2"), reason="there are no such signals")
@pytest.mark.parametrize(
    ("log", "is_dumped"),
    [
        (None, True),
        ("began\n", True),
        ("the event loop has been blocked for 1.0 s in a.py:3 in tick\n", False),
        ("the event loop has been blocked for 1.0 s in a.py:3 in tick\n" + 9000 * ".", True),
    ],
)
def test_the_stacks_of_a_blocked_process(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, log: str | None, is_dumped: bool
) -> None:
    """They are asked for only if the process has not logged its line itself, of late."""
    file = tmp_path / "a.log"
    if log is not None:
        file.write_text(log)
    sent: list[int] = []
    monkeypatch.setattr(process_tree, "kill", lambda pid, number: sent.append(number))
    process = Process("/a", [PlannedNode("/a", "x:A", HERE, HERE)], str(file))
    assert health._why(process) == f"its event loop is blocked; its log shows where: {file}"
    assert sent == ([signal.SIGUSR2] if is_dumped else [])
