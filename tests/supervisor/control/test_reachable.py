"""A graph that verbs cannot find any more makes itself known again."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from graphflow.system import is_portable
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.running import GOOD, rows, supervisor_of, write

pytestmark = pytest.mark.real


@slow
def test_a_run_directory_that_is_taken_away(machine: Machine, project: Path) -> None:
    """As at a logout: it is made again, and verbs find the graph as before."""
    up = machine.start("up", write(project, GOOD), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    shutil.rmtree(machine.run_directory / "graphflow")
    up.wait_for("the run directory was removed, and has been restored")
    assert rows(machine)["/a"]["state"] == "ready"
    machine.look("down")
    assert up.wait() == 0


@slow
@pytest.mark.skipif(is_portable(), reason="the portable way has a port")
def test_a_socket_that_is_removed(machine: Machine, project: Path) -> None:
    """It is made again; `down` waits for that, and the nodes are stopped as ever."""
    up = machine.start("up", write(project, GOOD), cwd=project)
    up.wait_for("Stop with Ctrl-C")
    Path(supervisor_of(machine)["socket"]).unlink()
    text = machine.look("down")
    assert "/a ended" in text
    assert "killed" not in text
    assert up.wait() == 0
    assert "the control socket was removed, and has been restored" in up.text
