"""A guardian that is killed is followed by another, which does its work."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import psutil
import pytest

from graphflow.supervisor.processes.orphaned import LOG_VARIABLE
from graphflow.supervisor.processes.successor import INTENSITY, GuardianWatch, left_of
from graphflow.supervisor.rundir import SUPERVISOR_LOG, GraphRun, start_time
from graphflow.system import is_portable
from tests.cases import slow
from tests.conftest import LIMIT, PROGRAMS, Machine, Program, alive
from tests.supervisor.running import nothing_is_left, rows, supervisor_of, write
from tests.until import until

pytestmark = [
    pytest.mark.real,
    pytest.mark.skipif(is_portable(), reason="the portable way has no guardian: workers end by themselves"),
]
GRAPH = """\
nodes:
  /n: {class: nodes.nursery:Nursery}
  /p: {command: [sh, -c, "trap '' TERM; sleep 600 & wait; sleep 600"]}
"""


def run_of(guardian: int, logs: Path) -> GraphRun:
    """A run of this process, as its supervisor."""
    began = start_time(os.getpid()) or 0.0
    made = GraphRun("id", "lab", 7, os.getpid(), began, 0.0, "lab.yaml", "", str(logs), "", "", guardian)
    return replace(made, guardian_started=start_time(guardian) or 0.0)


def test_a_guardian_is_followed_by_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """But not for ever, and each time it is said; a process that merely has its number is none."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    assert GuardianWatch(run_of(0, tmp_path)).check() == ""
    assert GuardianWatch(run_of(os.getppid(), tmp_path)).check() == ""

    guard = GuardianWatch(run_of(1, tmp_path))
    for _ in range(INTENSITY.max_restarts):
        former = guard.run.guardian
        told = guard.check()
        assert told == f"the guardian, process {former}, was ended; process {guard.run.guardian} has taken its place"
        assert guard.run.unguarded == ""
        assert guard.check() == ""
        psutil.Process(guard.run.guardian).kill()
        assert guard._successor is not None
        guard._successor.wait()
    assert guard.check().endswith("the graph goes on without it: started again 3 times within 60 s")
    assert guard.check() == ""
    assert guard._successor is not None
    assert guard._successor.stdin is not None
    guard._successor.stdin.close()


def test_what_is_left_of_a_graph(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A process with a log of the graph as its output or in its environment, with its descendants; never the caller."""
    log = tmp_path / "n.log"
    with open(log, "wb") as out:
        writing = subprocess.Popen(["sleep", "600"], stdout=out)
    marked = subprocess.Popen(["sh", "-c", "sleep 600 & wait"], env={**os.environ, LOG_VARIABLE: str(log)})
    other = subprocess.Popen(["sleep", "600"], env={**os.environ, LOG_VARIABLE: f"{tmp_path}2/n.log"})
    try:
        parent = psutil.Process(marked.pid)
        while not parent.children():
            assert marked.poll() is None
        found = left_of(str(tmp_path))
        assert {writing.pid, marked.pid, *(child.pid for child in parent.children())} == set(found)
        assert other.pid not in found
        with monkeypatch.context() as patch:
            patch.setattr(os, "getpid", lambda: marked.pid)
            assert {*found} - {*left_of(str(tmp_path))} == {marked.pid}
    finally:
        for pid in (*left_of(str(tmp_path)), other.pid):
            os.kill(pid, signal.SIGKILL)
        for process in (writing, marked, other):
            process.wait()


@slow
def test_the_end_of_its_supervisor(tmp_path: Path) -> None:
    """It ends what is left, and says so in the log."""
    note = {"domain": 7, "graph": "lab", "pid": 5, "logs": str(tmp_path)}
    left = subprocess.Popen(["sleep", "600"], env={**os.environ, LOG_VARIABLE: str(tmp_path / "n.log")})
    env = {**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)}
    tmp_path.chmod(0o700)
    command = [sys.executable, "-m", "graphflow.supervisor.processes.successor"]
    subprocess.run(command, input=json.dumps(note).encode() + b"\n", env=env, timeout=20, check=True)
    assert left.wait(5) == -signal.SIGKILL
    assert "the supervisor, process 5, was ended by an unknown cause" in (tmp_path / SUPERVISOR_LOG).read_text()


def ignored_by(pid: int) -> set[int]:
    """The signals that a process ignores, as proc(5) has them."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    mask = int(next(line.split()[1] for line in lines if line.startswith("SigIgn:")), 16)
    return {number for number in range(1, 65) if mask >> (number - 1) & 1}


def test_signals_to_it(tmp_path: Path) -> None:
    """It stays until its supervisor ends, whatever the terminal sends to all."""
    note = {"domain": 7, "graph": "lab", "pid": 5, "logs": str(tmp_path)}
    tmp_path.chmod(0o700)
    command = [sys.executable, "-m", "graphflow.supervisor.processes.successor"]
    env = {**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)}
    successor = subprocess.Popen(command, stdin=subprocess.PIPE, env=env, start_new_session=True)
    assert successor.stdin is not None
    try:
        numbers = signal.SIGINT, signal.SIGHUP, signal.SIGTERM
        until(lambda: ignored_by(successor.pid).issuperset(numbers), "it ignores them")
        for number in numbers:
            successor.send_signal(number)
        successor.communicate(json.dumps(note).encode() + b"\n", timeout=LIMIT)
        assert successor.returncode == 0
    finally:
        successor.kill()
        successor.wait()


@pytest.fixture
def unguarded(machine: Machine, project: Path) -> tuple[Program, list[int]]:
    """A graph whose guardian was killed and followed by another, and all of its processes."""
    (project / "nodes" / "nursery.py").write_text((PROGRAMS / "supervisor" / "nursery.py").read_text())
    up = machine.start("up", write(project, GRAPH), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    guardian = supervisor.ppid()
    os.kill(guardian, signal.SIGKILL)
    up.wait_for(f"the guardian, process {guardian}, was ended; process ")
    machine.until(lambda: supervisor_of(machine)["guardian"] != guardian, "the run file has the other")
    return up, [supervisor.pid, *(child.pid for child in supervisor.children(recursive=True))]


@slow
def test_a_graph_goes_on_with_another_guardian(machine: Machine, unguarded: tuple[Program, list[int]]) -> None:
    """Nothing is amiss with it, and it goes down as any other."""
    up, processes = unguarded
    assert {row["state"] for row in rows(machine).values()} == {"ready"}
    assert "guardian" not in machine.look("ps")
    machine.look("down")
    assert up.wait() == 0
    nothing_is_left(machine, processes)


@slow
@pytest.mark.parametrize("with_preload", [False, True])
def test_a_supervisor_that_is_killed_after_its_guardian(
    machine: Machine, unguarded: tuple[Program, list[int]], with_preload: bool
) -> None:
    """Nothing is left, not even where the preload process is killed too, and `up` says what happened."""
    up, processes = unguarded
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    preload = next(child.pid for child in supervisor.children() if child.name() == "gf-preload")
    supervisor.suspend()
    for pid in (preload, supervisor.pid) if with_preload else (supervisor.pid,):
        os.kill(pid, signal.SIGKILL)
    machine.until(lambda: not any(map(alive, processes)), "all processes are gone")
    assert up.wait() == 1
    assert f"the supervisor, process {supervisor.pid}, was ended by an unknown cause" in up.text
    nothing_is_left(machine, processes)
