"""From a graph file to a running supervisor: what is refused, and what a start that is broken off leaves."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest

from graphflow.supervisor.launching import launch as module
from graphflow.supervisor.launching.launch import Launched, launch
from graphflow.supervisor.processes.lifeline import LET_GO
from graphflow.system import is_portable
from graphflow.transport.rendezvous import address
from tests.cases import slow, some
from tests.conftest import PROGRAMS, Machine
from tests.supervisor.running import GOOD, nothing_is_left, rows, supervisor_of, write


@slow
@pytest.mark.real
def test_the_same_graph_twice_is_an_error(machine: Machine, project: Path) -> None:
    """The second says since when it runs and how to stop it; the first is not touched."""
    file = write(project, GOOD)
    machine.run("up", "-d", file, cwd=project)

    text = machine.run("up", file, cwd=project, code=1)

    assert "graph lab is already running" in text
    assert "graphflow down --graph lab" in text
    assert set(rows(machine)) == {"/a", "/b"}
    machine.look("down")


@slow
@pytest.mark.real
def test_a_node_name_that_is_taken_is_refused_before_anything_starts(machine: Machine, project: Path) -> None:
    """The owner is named; two graphs with other names may run beside each other, and then `down` asks which."""
    machine.run("up", "-d", write(project, GOOD), cwd=project)

    text = machine.run("up", write(project, GOOD, "other.yaml"), cwd=project, code=1)
    assert "already in domain" in text
    assert f"process {rows(machine)['/a']['pid']}" in text

    machine.run("up", "-d", write(project, "nodes:\n  /c: {class: nodes.lab:Good}\n", "third.yaml"), cwd=project)
    assert "lab" in (text := machine.look("down", code=2))
    assert "--graph NAME" in text
    machine.look("down", "--graph", "third")
    machine.look("down")


@slow
@pytest.mark.real
def test_a_log_folder_that_cannot_be_written_is_an_error_before_anything_starts(
    machine: Machine, project: Path
) -> None:
    """The text names the folder and the variable that moves it."""
    machine.env["ROS_LOG_DIR"] = "/proc/nowhere"
    text = machine.run("up", write(project, GOOD), cwd=project, code=1)
    assert "/proc/nowhere/lab" in text
    assert "ROS_LOG_DIR" in text
    nothing_is_left(machine, [])


@slow
@pytest.mark.real
def test_a_taken_port_is_an_error_before_anything_starts(machine: Machine, project: Path) -> None:
    """The error names the process at the rendezvous's address, and no node is started."""
    _, port = address(machine.endpoint)
    with socket.create_server(("127.0.0.1", port)):
        text = machine.run("up", write(project, GOOD), cwd=project, code=1)
    assert f"process {os.getpid()}" in text
    assert "did not answer as Zenoh" in text
    assert "set GRAPHFLOW_RENDEZVOUS=tcp/127.0.0.1:OTHER_PORT" in text
    nothing_is_left(machine, [])


@pytest.mark.real
def test_ctrl_c_while_the_graph_comes_up_leaves_nothing(machine: Machine, project: Path) -> None:
    """A start that takes long can be broken off."""
    shutil.copy(PROGRAMS / "supervisor" / "slow_import.py", project / "nodes")
    up = machine.start("up", write(project, "nodes:\n  /s: {class: nodes.slow_import:Late}\n"), cwd=project)
    machine.until(lambda: len(family_of(up.pid)) >= 2 + HAS_GUARDIAN, "the preload process is there")
    family = family_of(up.pid)

    up.end(signal.SIGINT)

    nothing_is_left(machine, family)


@pytest.mark.real
@pytest.mark.parametrize("sent", some(["SIGKILL", "SIGTERM", "SIGHUP", "SIGINT"], "SIGKILL"))
@pytest.mark.parametrize("way", some(["--no-console", "--detach"], "--detach"))
def test_a_command_that_ends_before_its_graph_is_up_leaves_nothing(
    machine: Machine, project: Path, sent: str, way: str
) -> None:
    """Whatever ends it, and also if it was going to leave the graph in the background."""
    shutil.copy(PROGRAMS / "supervisor" / "slow_import.py", project / "nodes")
    up = machine.start("up", way, write(project, "nodes:\n  /s: {class: nodes.slow_import:Late}\n"), cwd=project)
    machine.until(lambda: len(family_of(up.pid)) >= 2 + HAS_GUARDIAN, "the preload process is there")
    family = family_of(up.pid)

    up.process.send_signal(getattr(signal, sent))
    up.process.wait(10.0)

    nothing_is_left(machine, family)


HAS_GUARDIAN = not is_portable()


def family_of(pid: int) -> list[int]:
    """Return the descendants of a command; empty once it has ended."""
    try:
        return [child.pid for child in psutil.Process(pid).children(recursive=True)]
    except psutil.NoSuchProcess:
        return []


class Begun:
    """Stands for a supervisor that has begun: it reports some bytes, and ends."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *chunks: bytes) -> None:
        self.job: dict[str, Any] = {}
        self.is_reaped = False
        self.lifeline = -1
        self.chunks = chunks
        for way in ("_begin_forked", "_begin_portable"):
            monkeypatch.setattr(module, way, self.begin)

    def begin(self, job: dict[str, Any]) -> Launched:
        self.job = job
        self.lifeline, held = os.pipe()
        read, write = os.pipe()
        for chunk in self.chunks:
            os.write(write, chunk)
        os.close(write)
        return Launched(read, held, self.reap)

    def reap(self) -> str:
        self.is_reaped = True
        return "the supervisor was ended by signal SIGKILL"


def test_a_supervisor_that_reports(monkeypatch: pytest.MonkeyPatch) -> None:
    """It got the whole job, its report may come in pieces, and it runs on."""
    report = {"ok": True, "run": {"pid": 5}, "classes": {}}
    data = json.dumps(report).encode() + b"\n"
    begun = Begun(monkeypatch, data[:5], data[5:])
    told, launched = launch(Path("g.yaml"), ["a:=1"], 7)
    assert told == report
    assert begun.job == {"file": "g.yaml", "given": ["a:=1"], "domain": 7, "only": [], "debug": [], "watch": False}
    assert not begun.is_reaped
    launched.let_go()
    assert os.read(begun.lifeline, 2) == LET_GO
    os.close(launched.lifeline)  # as the command's end does
    assert os.read(begun.lifeline, 2) == b""
    os.close(begun.lifeline)


def test_a_supervisor_that_has_ended_is_let_go() -> None:
    """Nobody is there to be told, and that is no error."""
    read, write = os.pipe()
    os.close(read)
    Launched(-1, write, str).let_go()
    os.close(write)


def test_a_supervisor_that_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its reason comes back, and it leaves no zombie."""
    report = {"ok": False, "exit_code": 2, "message": "g.yaml:1:1: no"}
    begun = Begun(monkeypatch, json.dumps(report).encode() + b"\n")
    assert launch(Path("g.yaml"), [], None)[0] == report
    assert begun.is_reaped


def test_a_supervisor_that_dies(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is told as a failure with its cause, also if it was killed while it reported."""
    for chunks in ((), (b'{"ok": true, "ru',)):
        Begun(monkeypatch, *chunks)
        report, _ = launch(Path("g.yaml"), [], None)
        message = "the supervisor was ended by signal SIGKILL before the graph was up"
        assert report == {"ok": False, "exit_code": 1, "message": message}


@pytest.mark.real
@pytest.mark.skipif(is_portable(), reason="the portable way has no guardian")
@pytest.mark.parametrize("victim", some(["guardian", "supervisor", "preload"], "preload"))
def test_a_start_whose_processes_are_killed(machine: Machine, project: Path, victim: str) -> None:
    """As soon as the last of the three is there: the end is told with its cause, and nothing is left."""
    shutil.copy(PROGRAMS / "supervisor" / "slow_import.py", project / "nodes")
    up = machine.start("up", "-d", write(project, "nodes:\n  /s: {class: nodes.slow_import:Late}\n"), cwd=project)
    machine.until(lambda: len(family_of(up.pid)) >= 3, "the preload process is there")
    family = family_of(up.pid)
    os.kill(family[["guardian", "supervisor", "preload"].index(victim)], signal.SIGKILL)
    if victim == "guardian":
        assert up.wait() == 0
        machine.until(lambda: supervisor_of(machine)["guardian"] != family[0], "another has taken its place")
        assert "graph lab is down" in machine.look("down")
    else:
        assert up.wait() == 1
        assert "was ended by signal SIGKILL" in up.text
    assert "Traceback" not in up.text
    nothing_is_left(machine, family)


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("text", "code", "told"),
    [
        ("nodes: {/a: {class: nodes.lab:God}}\n", 2, "did you mean 'Good'?\n1 problem; nothing was started\n"),
        ("nods: {}\nnodes: {/a: {}}\n", 2, "2 problems; nothing was started\n"),
        ("nodes: {/a: {class: nodes.lab:Good}}\ndomain: no\n", 2, "1 problem; nothing was started\n"),
    ],
)
def test_a_wrong_file_is_refused(machine: Machine, project: Path, text: str, code: int, told: str) -> None:
    """All its problems at once, and the exit code of wrong usage."""
    assert told in machine.run("up", write(project, text), cwd=project, code=code)
    nothing_is_left(machine, [])


MOMENTS = [n / 40 for n in range(50)]
"""Seconds after which a start is broken off: a graph is up in less than the last."""


@pytest.mark.real
@pytest.mark.parametrize("moment", some(MOMENTS, MOMENTS[9], MOMENTS[21]))
def test_ctrl_c_at_any_moment(machine: Machine, project: Path, moment: float) -> None:
    """Once at every other one, twice at the others: nothing is left, and no traceback is shown."""
    up = machine.start("up", "--no-console", write(project, GOOD), cwd=project)
    seen: set[int] = set()
    deadline = time.monotonic() + moment
    while time.monotonic() < deadline:
        seen.update(family_of(up.pid))
        time.sleep(0.01)  # the moment is what differs between the cases
    for _ in range(1 + round(moment * 40) % 2):
        seen.update(family_of(up.pid))
        up.process.send_signal(signal.SIGINT)
        time.sleep(0.15)  # more than signals that count as one
    up.process.wait(15.0)
    nothing_is_left(machine, sorted(seen))
    assert "Traceback" not in up.text


@slow
@pytest.mark.real
def test_ctrl_c_while_a_program_prints_what_the_file_needs(machine: Machine, project: Path) -> None:
    """It ends with the command that waits for it."""
    script = "echo $$ > pid.new; mv pid.new pid; exec sleep 60"
    text = f"args:\n  x: {{default: $(command 'sh -c \"{script}\"')}}\n{GOOD}"
    up = machine.start("up", "--no-console", write(project, text), cwd=project)
    machine.until((project / "pid").exists, "the program runs")
    up.process.send_signal(signal.SIGINT)
    up.process.wait(15.0)
    nothing_is_left(machine, [int((project / "pid").read_text())])


@slow
@pytest.mark.real
@pytest.mark.skipif(is_portable(), reason="the portable way has no signals")
def test_a_stopped_rendezvous_is_named(machine: Machine, project: Path) -> None:
    """The supervisor of another graph, say: whoever wants to join is told its process, and soon."""
    machine.run("up", "-d", write(project, GOOD), cwd=project)
    host = supervisor_of(machine)["pid"]
    os.kill(host, signal.SIGSTOP)
    try:
        other = write(project, "nodes:\n  /c: {class: nodes.lab:Good}\n", "other.yaml")
        text = machine.run("up", "-d", other, cwd=project, code=1)
    finally:
        os.kill(host, signal.SIGCONT)
    assert f"process {host}" in text
    assert f"kill -CONT {host}" in text


@slow
@pytest.mark.real
def test_a_run_directory_that_cannot_be_made(machine: Machine, project: Path) -> None:
    """The folder and the variable that moves it are named."""
    (project / "file").touch()
    machine.env["XDG_RUNTIME_DIR"] = str(project / "file" / "run")
    text = machine.run("up", "-d", write(project, GOOD), cwd=project, code=1)
    assert f"{project}/file/run/graphflow: Not a directory; set XDG_RUNTIME_DIR to a folder you can write to" in text


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk with room for a few hundred lines."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(folder)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("this user may not mount a disk")
    yield folder
    subprocess.run(["umount", "-l", str(folder)], check=True)


@slow
@pytest.mark.real
@pytest.mark.skipif(is_portable(), reason="the portable way does not watch its logs")
def test_a_full_disk_for_logs(machine: Machine, project: Path, small_disk: Path) -> None:
    """No node is lost: they run on, `ps` says that lines are, and the graph can be stopped."""
    machine.env["ROS_LOG_DIR"] = str(small_disk)
    text = "nodes:\n  /t: {class: nodes.talker:Talker, params: {rate: 1000.0}}\n  /b: {class: nodes.lab:Good}\n"
    machine.run("up", "-d", write(project, text), cwd=project)
    pids = {name: row["pid"] for name, row in rows(machine).items()}
    machine.until(lambda: "its log is incomplete" in rows(machine)["/t"]["detail"], "the disk is full")
    assert "its log is incomplete" in machine.look("ps")
    now = {name: (row["pid"], row["state"]) for name, row in rows(machine).items()}
    assert now == {name: (pid, "ready") for name, pid in pids.items()}
    assert "success=True" in machine.look("service", "call", "/b/ask", "std_srvs/srv/Trigger")
    machine.look("down")
    nothing_is_left(machine, list(pids.values()))
