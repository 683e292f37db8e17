"""`graphflow rclpy`, and running programs written for rclpy."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.rclpy import enabling
from tests.cases import slow
from tests.conftest import Machine


@slow
def test_python_is_let_import_it_and_not(machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One file is written and removed, and named each time."""
    file = tmp_path / enabling.FILE
    monkeypatch.setattr(enabling, "file", lambda: str(file))
    assert "not enabled" in machine.look("rclpy", "status")
    assert str(file) in machine.look("rclpy", "enable")
    assert file.read_text() == enabling.LINES
    assert machine.look("rclpy", "status").startswith("enabled")
    assert "was removed" in machine.look("rclpy", "disable")
    assert "nothing was changed" in machine.look("rclpy", "disable")
    assert not file.exists()


def test_where_it_cannot_be_written_that_is_said(
    machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error has an alternative."""
    monkeypatch.setattr(enabling, "file", lambda: str(tmp_path / "none" / enabling.FILE))
    refused = machine.look("rclpy", "enable", code=1)
    assert "in a virtual environment of your own" in refused


def test_a_sourced_ros_2_is_told(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """A sourced ROS 2 takes precedence, whatever was enabled."""
    monkeypatch.setattr(enabling, "elsewhere", lambda: "/opt/ros/rclpy/__init__.py")
    assert "/opt/ros/rclpy/__init__.py" in machine.look("rclpy", "status")


@slow
def test_a_file_that_uses_ros_is_run_as_it_stands(machine: Machine, tmp_path: Path) -> None:
    """A program written for rclpy runs unchanged, with its own arguments and exit."""
    file = tmp_path / "hello.py"
    file.write_text(
        "import sys\nimport rclpy\nrclpy.init()\nprint('hello', sys.argv[1:])\nrclpy.shutdown()\nsys.exit(3)\n"
    )
    ran = machine.run("run", str(file), "a", "--ros-args", "-p", "x:=1", code=3)
    assert ran == "hello ['a', '--ros-args', '-p', 'x:=1']\n"
