"""Programs that start launch descriptions themselves."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import Machine

PROGRAM = """
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def main():
    word, talker = LaunchConfiguration("word"), Node(package="demo_nodes_py", executable="talker")
    service = LaunchService(argv=sys.argv[1:])
    described = LaunchDescription([DeclareLaunchArgument("word", default_value="nothing"), talker])
    described.add_action(LogInfo(msg=["says ", word]))
    service.include_launch_description(described)
    code = service.run()
    print("it has ended with", code, flush=True)
    return code


if __name__ == "__main__":
    sys.exit(main())
"""


@pytest.mark.real
def test_a_program_starts_what_it_describes(machine: Machine, tmp_path: Path) -> None:
    """With its arguments; Ctrl-C, which the whole group of processes hears, stops it, and the program goes on."""
    (tmp_path / "bringup.py").write_text(PROGRAM)
    with subprocess.Popen(
        [sys.executable, "-m", "graphflow", "run", "bringup.py", "word:=hello"],
        cwd=tmp_path,
        env=machine.env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        text = ""
        try:
            for line in process.stdout:
                text += line
                if "Publishing" in line:
                    os.killpg(process.pid, signal.SIGINT)
            assert process.wait(20) == 0, text
        finally:
            process.kill()
    assert "says hello\n" in text
    assert text.endswith("it has ended with 0\n")


def test_its_file_is_a_launch_file_too(machine: Machine, tmp_path: Path) -> None:
    """What it would start is what it describes."""
    (tmp_path / "bringup.py").write_text(PROGRAM)
    plan = machine.look("plan", str(tmp_path / "bringup.py"), "word:=hello")
    assert "/talker\n  class    nodes.talker:Talker" in plan
    assert "log      says hello" in plan
