"""A process of the graph."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from tests.conftest import Machine
from tests.supervisor.running import rows, write

pytestmark = pytest.mark.real


def test_an_error_in_a_task_ends_the_node_with_its_traceback(machine: Machine, project: Path) -> None:
    """When all nodes have ended the graph has, with code 1 if one failed."""
    up = machine.start("up", write(project, "nodes:\n  /c: {class: nodes.lab:Crashes}\n"), cwd=project)

    assert up.wait() == 1

    assert "the bridge is out" in up.text
    assert "Traceback" in up.text
    assert "exit code 70" in up.text
    assert "lab.py" in up.text


def test_nodes_that_share_a_process_share_its_pid_and_its_end(machine: Machine, project: Path) -> None:
    """A crash ends the mates; nodes elsewhere go on."""
    text = (
        "nodes:\n  /a: {class: nodes.lab:Good, process: both}\n  /b: {class: nodes.lab:Good, process: both}\n"
        "  /c: {class: nodes.lab:Good}\n"
    )
    machine.run("up", "-d", write(project, text), cwd=project)
    found = rows(machine)
    assert found["/a"]["pid"] == found["/b"]["pid"] != found["/c"]["pid"]

    os.kill(found["/a"]["pid"], signal.SIGKILL)

    machine.until(lambda: rows(machine)["/b"]["state"] == "failed", "both are seen to have ended")
    assert rows(machine)["/c"]["state"] == "ready"
    machine.look("down")


def test_a_node_that_leaves_before_it_is_ready_has_failed(machine: Machine, project: Path) -> None:
    """Exit code 0 or not: what waits for it would wait for ever."""
    text = "nodes:\n  /gone: {class: nodes.lab:Leaves}\n  /good: {class: nodes.lab:Good, after: /gone}\n"
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 1
    assert "ended before it was ready: /gone" in up.text
