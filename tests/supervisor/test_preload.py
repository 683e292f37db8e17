"""The process that starts nodes."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from graphflow.system import is_portable
from tests.conftest import Machine, alive
from tests.supervisor.running import GOOD, nothing_is_left, rows, write

pytestmark = pytest.mark.real


@pytest.mark.skipif(is_portable(), reason="the portable way has no preload process")
def test_the_preload_process_has_one_thread(machine: Machine, project: Path) -> None:
    """Otherwise forking it would be unsafe."""
    machine.run("up", "-d", write(project, GOOD), cwd=project)
    pid = rows(machine)["/a"]["pid"]
    preload = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1]
    assert len(list(Path(f"/proc/{preload}/task").iterdir())) == 1
    machine.look("down")


def test_fresh_interpreter_for_variables_that_need_one(machine: Machine, project: Path) -> None:
    """`env:` with PYTHON..., LD_... or MALLOC_... starts the node in an interpreter of its own."""
    text = "nodes:\n  /a: {class: nodes.lab:Good, env: {PYTHONHASHSEED: 7, COLOUR: blue}}\n"
    machine.run("up", "-d", write(project, text), cwd=project)
    pid = rows(machine)["/a"]["pid"]
    assert b"graphflow.supervisor.worker" in Path(f"/proc/{pid}/cmdline").read_bytes()
    assert "blue" in machine.look("service", "call", "/a/ask", "std_srvs/srv/Trigger")
    machine.look("down")
    nothing_is_left(machine, [pid])


def test_an_impossible_environment_fails_its_node_only(machine: Machine, project: Path) -> None:
    """The process that starts nodes survives what cannot be started."""
    text = 'nodes:\n  /bad: {class: nodes.lab:Good, env: {"LD_A=B": x}}\n'
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 1
    assert "cannot be started" in up.text


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_what_a_node_has_started_goes_with_it(machine: Machine, project: Path, how: int) -> None:
    """A child process of a node does not outlive it, however the node ends."""
    up = machine.start("up", write(project, "nodes:\n  /p: {class: nodes.lab:Parent}\n"), cwd=project)
    machine.until(lambda: "child " in machine.look("logs", "/p", code=None), "it has a child")
    child = int(machine.look("logs", "/p").split("child ")[1].split(".")[0])
    assert alive(child)

    os.kill(rows(machine)["/p"]["pid"], how)

    machine.until(lambda: not alive(child), "the child is gone")
    up.wait()
