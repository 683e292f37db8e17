"""`graphflow snapshot`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_a_picture(machine: Machine, tmp_path: Path) -> None:
    """turtlesim's drawing becomes a picture; impossible requests are explained."""
    machine.run("up", "-d", "turtlesim", cwd=tmp_path)
    assert machine.look("snapshot", cwd=tmp_path) == "turtlesim.svg\n"
    assert (tmp_path / "turtlesim.svg").read_text(encoding="utf-8").startswith("<svg")
    assert machine.look("snapshot", "a.svg", "--node", "turtlesim", cwd=tmp_path) == "a.svg\n"
    assert "name it a.svg" in machine.look("snapshot", "a.png", code=2)
    assert "/turtle1/leader draws nothing" in machine.look("snapshot", "--node", "/turtle1/leader", code=1)
    assert "did you mean '/turtlesim'?" in machine.look("snapshot", "--node", "turtlesm", code=1)
    assert "/nowhere/a.svg: No such file or directory" in machine.look("snapshot", "/nowhere/a.svg", code=1)


def test_nobody_draws(standing: Machine) -> None:
    """Without a simulator, the error says how to start one."""
    assert "start turtlesim: graphflow up turtlesim" in standing.look("snapshot", code=1)
