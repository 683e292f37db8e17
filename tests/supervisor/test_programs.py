"""Foreign programs in a graph: started, logged, asked to end, and never left behind."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import psutil
import pytest

from graphflow.system import is_portable
from tests.cases import slow, some
from tests.conftest import Machine, alive
from tests.supervisor.running import nothing_is_left, rows, supervisor_of, write

pytestmark = pytest.mark.real

SHELL = """\
nodes:
  /a: {class: nodes.lab:Good}
  /p:
    command: [sh, -c, 'trap "echo cleaned up; exit 0" TERM; echo "$COLOUR here"; sleep 600 & wait']
    env: {COLOUR: red}
    after: /a
"""


def pids_of(machine: Machine) -> list[int]:
    return [row["pid"] for row in rows(machine).values()]


def log_of(machine: Machine) -> Path:
    return Path(rows(machine)["/p"]["log"])


def test_a_program_is_like_a_node(machine: Machine, project: Path) -> None:
    """Its output is logged, it has its environment and the usual signals, it is asked to end; so is what it started."""
    machine.run("up", "-d", write(project, SHELL), cwd=project)
    pids, log = pids_of(machine), log_of(machine)
    machine.until(lambda: "red here" in log.read_text(), "it has begun")
    children = [child.pid for child in psutil.Process(rows(machine)["/p"]["pid"]).children()]
    assert rows(machine)["/p"]["class"].startswith("sh -c")
    assert "/p runs again, process" in machine.look("restart", "/p")
    machine.look("down")
    nothing_is_left(machine, [*pids, *children])
    assert log.read_text().count("cleaned up") == (0 if is_portable() and os.name == "nt" else 2)


@pytest.mark.skipif(is_portable(), reason="the portable way has no guardian")
@pytest.mark.parametrize("victim", some(["supervisor", "preload"], "preload"))
def test_it_ends_with_the_graph(machine: Machine, project: Path, victim: str) -> None:
    """Whichever of the graph's processes is killed, it is asked to end, and has."""
    machine.run("up", "-d", write(project, SHELL), cwd=project)
    pids, log = pids_of(machine), log_of(machine)
    machine.until(lambda: "red here" in log.read_text(), "it has begun")
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    [preload] = supervisor.children()
    os.kill(supervisor.pid if victim == "supervisor" else preload.pid, signal.SIGKILL)
    nothing_is_left(machine, pids)
    assert "cleaned up" in log.read_text()


RESTARTS = """\
nodes:
  /a: {class: nodes.lab:Good, restart: on_failure}
  /p: {command: [sleep, "600"], restart: {policy: always, delay: 0.05}}
"""


@slow
def test_killed_processes_are_started_again(machine: Machine, project: Path) -> None:
    """With a new process, and what was is known; `down` ends the new ones."""
    machine.run("up", "-d", write(project, RESTARTS), cwd=project)
    before = {name: row["pid"] for name, row in rows(machine).items()}
    for pid in before.values():
        os.kill(pid, signal.SIGKILL)
    machine.until(lambda: {row["restarts"] for row in rows(machine).values()} == {1}, "both are started again")
    machine.until(lambda: {row["state"] for row in rows(machine).values()} == {"ready"}, "both are ready")
    after = rows(machine)
    assert all(after[name]["pid"] != pid and not alive(pid) for name, pid in before.items())
    assert "started again: once" in machine.look("status", "/a")
    assert "its last end: signal SIGKILL" in machine.look("status", "/a")
    machine.look("down")
    nothing_is_left(machine, [row["pid"] for row in after.values()])


def test_a_program_that_cannot_be_started(machine: Machine, project: Path) -> None:
    """It is a mistake in the file, found before anything is started."""
    text = machine.run("up", write(project, "nodes: {/p: {command: [no-such-program]}}"), cwd=project, code=2)
    assert "the program 'no-such-program' cannot be started: it is not on the PATH" in text
