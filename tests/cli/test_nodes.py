"""`restart` and `stop`: single nodes of a graph that really runs."""

from __future__ import annotations

import os
import signal

import pytest

from tests.conftest import Machine, alive
from tests.supervisor.running import GOOD, make_project, rows, write

pytestmark = pytest.mark.real


def test_restart_and_stop(machine: Machine) -> None:
    """A node gets a new process, whether it ran, was killed or was stopped; the others run on; misspelt is told."""
    project = make_project(machine.run_directory / "lab")
    file = write(project, GOOD)
    machine.run("up", "-d", file, cwd=project)
    before = rows(machine)
    assert "/a runs again, process" in machine.look("restart", "a")
    after = rows(machine)
    assert after["/a"]["pid"] != before["/a"]["pid"]
    assert after["/b"]["pid"] == before["/b"]["pid"]
    assert after["/a"]["restarts"] == 1
    assert not alive(before["/a"]["pid"])

    assert "/a has ended" in machine.look("stop", "/a")
    assert rows(machine)["/a"]["state"] == "ended"
    assert "/a runs again" in machine.look("restart", "/a")

    os.kill(rows(machine)["/a"]["pid"], signal.SIGKILL)
    machine.until(lambda: rows(machine)["/a"]["state"] == "failed", "it is seen to have died")
    assert "/a runs again" in machine.look("restart", "/a")
    assert rows(machine)["/a"]["restarts"] == 3
    assert "has no node /aa; did you mean '/a'?" in machine.look("restart", "/aa", code=1)
    machine.look("down")
