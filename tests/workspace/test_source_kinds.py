"""Files for ROS 2, and files for graphflow."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.workspace import source_kinds
from graphflow.workspace.source_kinds import uses_ros


@pytest.mark.parametrize(
    ("text", "verdict"),
    [
        ("import rclpy", True),
        ("import os, rclpy.node as n", True),
        ("def f():\n    from rclpy.node import Node", True),
        ("from graphflow import Node", False),
        ("from .rclpy import x", False),
        ("'import rclpy'", False),
        ("import (", False),
        ("from nav_msgs.msg import Path", True),
        ("from turtlesim.srv import Spawn", True),
        ("from graphflow.msgs.nav_msgs.msg import Path", False),
        ("import os.path", False),
    ],
)
def test_files_that_use_rclpy_are_told_from_others(tmp_path: Path, text: str, verdict: bool) -> None:
    """By their imports."""
    (tmp_path / "a.py").write_text(text)
    assert uses_ros(tmp_path / "a.py") is verdict
    (tmp_path / "a.py").write_bytes(b"\xef\xbb\xbf" + (tmp_path / "a.py").read_bytes())  # as some editors save it
    assert uses_ros(tmp_path / "a.py") is verdict


def test_a_file_that_starts_a_program_beside_it(tmp_path: Path) -> None:
    """It uses ROS if that does; a file of graphflow's may import what it likes."""
    (tmp_path / "talk.py").write_text("import rclpy")
    (tmp_path / "step.py").write_text("from talk import main\nimport start")
    (tmp_path / "start.py").write_text("import json\nfrom step import main")
    (tmp_path / "node.py").write_text("import graphflow, talk")
    (tmp_path / "through.py").write_text("import node")
    assert uses_ros(tmp_path / "start.py")
    assert not uses_ros(tmp_path / "node.py")
    assert not uses_ros(tmp_path / "through.py")


def test_only_some_modules_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A chain of imports may be long, or go round."""
    monkeypatch.setattr(source_kinds, "_FOLLOWED", 3)
    for number in range(4):
        (tmp_path / f"m{number}.py").write_text(f"import m{number + 1}")
    (tmp_path / "a.py").write_text("import b")
    (tmp_path / "b.py").write_text("import a")
    assert not uses_ros(tmp_path / "a.py")
    (tmp_path / "m3.py").write_text("import rclpy")
    assert uses_ros(tmp_path / "m1.py")
    assert not uses_ros(tmp_path / "m0.py")
