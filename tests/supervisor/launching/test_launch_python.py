"""Launch files in Python, run to describe themselves."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.supervisor.launching import launch_python
from graphflow.supervisor.launching.launch_python import described
from tests.cases import slow


def test_what_it_describes(tmp_path: Path) -> None:
    """Actions, with their lines."""
    file = tmp_path / "a.launch.py"
    file.write_text(
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        "def generate_launch_description():\n    return LaunchDescription([Node(package='a', executable='b')])\n"
    )
    told = described(file, "a.launch.py", {})
    assert told["problems"] == []
    assert told["actions"] == [{"node": {"line": 4, "pkg": "a", "exec": "b"}}]


@slow
def test_what_it_prints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It is shown to whoever starts it, and to nobody else."""
    file = tmp_path / "a.launch.py"
    file.write_text(
        "from launch import LaunchDescription\nprint('reading')\n"
        "def generate_launch_description():\n    print('describing')\n    return LaunchDescription([])\n"
    )
    described(file, "a.launch.py", None)
    assert capsys.readouterr().err == ""
    described(file, "a.launch.py", {})
    assert capsys.readouterr().err == "reading\ndescribing\n"


@slow
@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("import os; os._exit(3)", "it ended without a launch description"),
        ("import time; time.sleep(60)", "it did not return a launch description within 0.5 s"),
    ],
)
def test_what_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, why: str) -> None:
    """It is said how."""
    monkeypatch.setattr(launch_python, "PYTHON_LIMIT", 0.5 if "sleep" in text else 20.0)
    file = tmp_path / "a.launch.py"
    file.write_text(text)
    with pytest.raises(GraphFileError, match=why):
        described(file, "a.launch.py", {})
