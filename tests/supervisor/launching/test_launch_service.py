"""Programs that start launch descriptions themselves."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import Machine
from tests.until import until

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


@slow
@pytest.mark.real
def test_a_program_starts_what_it_describes(machine: Machine, tmp_path: Path) -> None:
    """With its arguments; Ctrl-C, which the whole group of processes hears, stops it, and the program goes on."""
    (tmp_path / "bringup.py").write_text(PROGRAM)
    with started(machine, tmp_path) as (process, output):
        until(lambda: "Publishing" in output.read_text(), output.read_text)
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(30) == 0, output.read_text()
    assert "says hello\n" in output.read_text()
    assert output.read_text().endswith("it has ended with 0\n")


@slow
@pytest.mark.real
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_what_it_has_started_ends_with_the_program(machine: Machine, tmp_path: Path, number: signal.Signals) -> None:
    """Also where that cannot say so."""
    (tmp_path / "bringup.py").write_text(PROGRAM)
    with started(machine, tmp_path) as (process, output):
        until(lambda: "Publishing" in output.read_text(), output.read_text)
        process.send_signal(number)
        assert process.wait(30) == (0 if number == signal.SIGTERM else -number)
        until(lambda: not is_group(process.pid), output.read_text)


@contextmanager
def started(machine: Machine, folder: Path) -> Iterator[tuple[subprocess.Popen[bytes], Path]]:
    """The program as its own group of processes, and the file with what they print."""
    output = folder / "output"
    command = [sys.executable, "-m", "graphflow", "run", "bringup.py", "word:=hello"]
    with output.open("wb") as file:
        process = subprocess.Popen(
            command, cwd=folder, env=machine.env, stdout=file, stderr=subprocess.STDOUT, start_new_session=True
        )
    try:
        yield process, output
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait(10)


def is_group(pid: int) -> bool:
    """Whether any process is left of a group."""
    try:
        os.killpg(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_its_file_is_a_launch_file_too(machine: Machine, tmp_path: Path) -> None:
    """The description is that of the launch it would start."""
    (tmp_path / "bringup.py").write_text(PROGRAM)
    plan = machine.look("plan", str(tmp_path / "bringup.py"), "word:=hello")
    assert "/talker\n  class    nodes.talker:Talker" in plan
    assert "log      says hello" in plan
