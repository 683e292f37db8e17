"""Whatever ends the supervisor: its guardian leaves nothing of the graph."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from graphflow.supervisor.rundir import RunDirectory
from graphflow.system import is_portable
from tests.cases import slow, some
from tests.conftest import PROGRAMS, Machine, alive
from tests.supervisor.running import nothing_is_left, rows, supervisor_of, write

pytestmark = [
    pytest.mark.real,
    pytest.mark.skipif(is_portable(), reason="the portable way has no guardian: workers end by themselves"),
]

GUARDED = """
import os, signal, subprocess, sys, time
from graphflow.supervisor.processes.guardian import guard, leave_note

def supervise():
    leave_note(write, 7, "lab", {log!r})
    subprocess.Popen(["sleep", "600"], start_new_session=True)
    {end}
    return 3

read, write = os.pipe()
guard(supervise, read, (write,))
"""


@pytest.mark.parametrize(("end", "code"), [("...", 3), ("os.kill(os.getpid(), signal.SIGKILL)", 137)])
def test_the_end_of_a_supervisor(tmp_path: Path, end: str, code: int) -> None:
    """Its guardian ends what is left, has its exit code, and writes down what it did not live to say."""
    log = tmp_path / "log"
    made = [sys.executable, "-c", GUARDED.format(end=end, log=str(log))]
    run_in = tmp_path / "run"
    run_in.mkdir(0o700)
    assert subprocess.run(made, env={**os.environ, "XDG_RUNTIME_DIR": str(run_in)}, timeout=20).returncode == code
    if code == 3:
        assert not log.exists()
    else:
        text = log.read_text()
        assert "was ended by signal SIGKILL (killed, perhaps for lack of memory); its nodes have ended" in text
        assert "1 process that was left was killed" in text
        assert not list(run_in.glob("graphflow/*/*"))


@slow
@pytest.mark.parametrize("is_held", [True, False])
def test_a_guardian_that_can_write_nothing(tmp_path: Path, is_held: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """A run directory that the next graph has taken is left to it, a lost folder of logs costs the line; all ends."""
    run_in = tmp_path / "run"
    run_in.mkdir(0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(run_in))
    monkeypatch.setenv("STARTED", str(tmp_path / "started"))
    holder = RunDirectory(7, "lab")
    if is_held:
        holder.claim()
    log = (tmp_path if is_held else tmp_path / "gone") / "log"
    end = "open(os.environ['STARTED'], 'w').write(str(child.pid)); os.kill(os.getpid(), signal.SIGKILL)"
    code = GUARDED.format(end=end, log=str(log)).replace("subprocess.Popen", "child = subprocess.Popen")
    ended = subprocess.run([sys.executable, "-c", code], timeout=20)
    assert ended.returncode == 137
    assert not alive(int((tmp_path / "started").read_text()))
    assert holder.path.exists() == is_held
    assert log.exists() == is_held
    holder.release()


NURSERY = "nodes:\n  /n: {class: nodes.nursery:Nursery}\n  /m: {class: nodes.nursery:Nursery}\n"


@pytest.fixture
def nursery(machine: Machine, project: Path) -> list[int]:
    """All processes of a graph of two nodes, each of which has three children of different kinds."""
    (project / "nodes" / "nursery.py").write_text((PROGRAMS / "supervisor" / "nursery.py").read_text())
    machine.run("up", "-d", write(project, NURSERY), cwd=project)
    guardian = psutil.Process(supervisor_of(machine)["pid"]).parent()
    assert guardian is not None
    found = [guardian.pid, *(child.pid for child in guardian.children(recursive=True))]
    assert len(found) == 3 + 2 * 4
    return found


def role(machine: Machine, name: str) -> int:
    """The process id of one that has a part in the graph."""
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    [preload] = supervisor.children()
    node: int = rows(machine)["/n"]["pid"]
    return {"supervisor": supervisor.pid, "guardian": supervisor.ppid(), "preload": preload.pid, "node": node}[name]


@pytest.mark.parametrize(
    "victims",
    some(
        ["supervisor", "preload", "guardian supervisor", "supervisor guardian", "guardian supervisor preload"],
        "supervisor",
        "guardian supervisor preload",
    ),
)
def test_killed_processes_leave_nothing(machine: Machine, project: Path, nursery: list[int], victims: str) -> None:
    """Neither do several of them, one after the other; and the nodes had the time to clean up."""
    pids = [role(machine, name) for name in victims.split()]
    logs = Path(rows(machine)["/n"]["log"]).parent
    for pid in pids:
        os.kill(pid, signal.SIGKILL)

    machine.until(lambda: not any(map(alive, nursery)), "all processes are gone")
    if len(pids) > 1:  # nobody was left to remove the run directory; that hinders nothing
        machine.run("up", "-d", "lab.yaml", cwd=project)
        machine.look("down")
    nothing_is_left(machine, [])
    for name in ("n", "m"):
        assert "everybody goes to bed" in (logs / f"{name}.log").read_text()


@slow
def test_what_a_node_leaves_behind_goes_with_it(machine: Machine, nursery: list[int]) -> None:
    """Also what is in a session of its own; what belongs to another node stays."""
    node = role(machine, "node")
    its = {child.pid for child in psutil.Process(node).children(recursive=True)}
    os.kill(node, signal.SIGKILL)

    machine.until(lambda: rows(machine)["/n"]["state"] == "failed", "its end is known")
    machine.until(lambda: sum(map(alive, nursery)) == 3 + 4, "what it left is gone, and nothing else")
    assert not any(map(alive, its))
    machine.look("down")
    nothing_is_left(machine, nursery)


@slow
@pytest.mark.parametrize("name", some(["supervisor", "preload"], "supervisor"))
def test_down_ends_a_graph_whose_processes_are_stopped(machine: Machine, nursery: list[int], name: str) -> None:
    """It says which one does not answer."""
    pid = role(machine, name)
    os.kill(pid, signal.SIGSTOP)
    text = machine.look("down")
    if name == "supervisor":
        assert f"the supervisor, process {pid}, is stopped; killing it and ending its nodes" in text
    nothing_is_left(machine, nursery)


@slow
def test_a_node_that_dies_while_the_preload_process_is_stopped(machine: Machine, nursery: list[int]) -> None:
    """Its end is known all the same, and why nothing more can be said of it."""
    os.kill(role(machine, "preload"), signal.SIGSTOP)
    os.kill(role(machine, "node"), signal.SIGKILL)
    machine.until(lambda: rows(machine)["/n"]["state"] == "failed", "its end is known")
    assert rows(machine)["/n"]["detail"] == "an end whose cause is not known"
    machine.look("down")
    nothing_is_left(machine, nursery)


@slow
def test_ctrl_c_with_a_stopped_supervisor(machine: Machine, project: Path) -> None:
    """The first says what is wrong, the second ends the graph."""
    (project / "nodes" / "nursery.py").write_text((PROGRAMS / "supervisor" / "nursery.py").read_text())
    up = machine.start("up", write(project, NURSERY), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    family = [supervisor.pid, *(child.pid for child in supervisor.children(recursive=True))]
    supervisor.suspend()
    up.process.send_signal(signal.SIGINT)
    up.wait_for(f"the supervisor, process {supervisor.pid}, is stopped; Ctrl-C again ends the graph without it")
    up.process.send_signal(signal.SIGINT)
    assert up.wait() == 1
    assert f"the supervisor, process {supervisor.pid}, was ended by signal SIGKILL" in up.text
    nothing_is_left(machine, family)
