"""Workers and programs whose guardian, supervisor and preload process are killed at one moment."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from graphflow.supervisor.processes.orphaned import LOG_VARIABLE, left_by
from graphflow.system import is_portable
from tests.cases import slow
from tests.conftest import Machine, alive
from tests.supervisor.running import rows, supervisor_of, write

pytestmark = [
    pytest.mark.real,
    pytest.mark.skipif(is_portable(), reason="the portable way has other processes"),
]

STUCK = """\
import subprocess, time
from graphflow import Node, timer

class Stuck(Node):
    def __init__(self):
        super().__init__("stuck")
        subprocess.Popen(["sleep", "600"], start_new_session=True)

    @timer(0.5)  # the node is ready before
    def tick(self):
        time.sleep(600)
"""
GRAPH = "nodes:\n  /n: {class: nodes.stuck:Stuck}\n  /p: {command: [sleep, '600']}\n"


@slow
def test_a_blocked_loop_and_a_program(machine: Machine, project: Path) -> None:
    """Neither cleans up by itself; both end, and so does what the node has started."""
    (project / "nodes" / "stuck.py").write_text(STUCK)
    machine.run("up", "-d", write(project, GRAPH), cwd=project)
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    [preload] = supervisor.children()
    started = [child.pid for child in preload.children(recursive=True)]
    assert len(started) == 3
    machine.until(lambda: "event loop" in Path(rows(machine)["/n"]["log"]).read_text(), "the loop is blocked")
    for pid in (supervisor.ppid(), supervisor.pid, preload.pid):
        os.kill(pid, signal.SIGKILL)
    machine.until(lambda: not any(map(alive, started)), "all processes are gone")
    for file in machine.run_directory.glob("graphflow/*/*/run.json"):  # which nobody was left to remove
        file.unlink()


LEAVING = """\
import os, subprocess
from graphflow import Node

class Leaving(Node):
    def __init__(self):
        super().__init__("leaving")
        subprocess.Popen(["sleep", "600"], start_new_session=True)
        subprocess.run(["sh", "-c", "setsid sleep 600 &"])
"""


@slow
def test_a_worker_that_ends_leaves_nothing(machine: Machine, project: Path) -> None:
    """Even before the preload process has noticed, and so whatever is killed then."""
    (project / "nodes" / "leaving.py").write_text(LEAVING)
    machine.run("up", "-d", write(project, "nodes:\n  /n: {class: nodes.leaving:Leaving}\n"), cwd=project)
    worker = rows(machine)["/n"]["pid"]
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    [preload] = supervisor.children()
    started = [child.pid for child in preload.children(recursive=True)]
    assert len(started) == 3
    for process in (supervisor, preload):
        process.suspend()
    os.kill(worker, signal.SIGTERM)
    machine.until(lambda: not any(map(alive, started)), "the worker and what it has started are gone")
    for process in (supervisor, preload):
        process.resume()
    machine.until(lambda: not alive(supervisor.pid), "the graph has ended with its only node")


def test_what_a_worker_has_left(tmp_path: Path) -> None:
    """It is known by its parent, its environment or its output; who only reads the log is left alone."""
    log = tmp_path / "n.log"
    log.touch()
    mine = subprocess.Popen(["sleep", "600"])
    daemon = "import subprocess; print(subprocess.Popen(['sleep', '600'], stdout={}).pid)"
    marked, printing = (
        int(subprocess.check_output([sys.executable, "-c", daemon.format(out)], env=env))
        for out, env in (
            ("subprocess.DEVNULL", {**os.environ, LOG_VARIABLE: str(log)}),
            (f"open({str(log)!r}, 'a')", dict(os.environ)),
        )
    )
    reader = int(subprocess.check_output([sys.executable, "-c", daemon.format("subprocess.DEVNULL")]))
    with log.open() as _:
        found = left_by(str(log))
    for pid in (mine.pid, marked, printing, reader):
        os.kill(pid, signal.SIGKILL)
    mine.wait(10.0)
    assert {mine.pid, marked, printing} <= set(found)
    assert not {reader, os.getpid()} & set(found)
