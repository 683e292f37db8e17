"""The script for a real ROS 2, held against graphflow's own command line, which prints the same."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import PROJECT, Machine

pytestmark = pytest.mark.real


def acceptance(machine: Machine, folder: Path, ros2: str) -> subprocess.CompletedProcess[str]:
    """Run the script with graphflow on the path."""
    (folder / "graphflow").write_text(f'#!/bin/sh\nexec {sys.executable} -m graphflow.cli.main "$@"\n')
    (folder / "graphflow").chmod(0o755)
    env = {k: v for k, v in machine.env.items() if k != "GRAPHFLOW_DOMAIN"}
    return subprocess.run(
        [PROJECT / "docs" / "ros2-acceptance.sh", "jazzy"],
        env={**env, "PATH": f"{folder}:{env['PATH']}", "ROS2": ros2, "ROS_DOMAIN_ID": str(machine.domain)},
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )


@slow
def test_graphflow_passes_its_own_acceptance(machine: Machine, tmp_path: Path) -> None:
    """Every expectation that needs no node of ROS 2 is met."""
    done = acceptance(machine, tmp_path, "graphflow")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "17 passed, 0 failed" in done.stdout


@slow
def test_a_failure_is_seen(machine: Machine, tmp_path: Path) -> None:
    """A command line that says nothing fails everything but what graphflow itself says, and the exit code tells."""
    done = acceptance(machine, tmp_path, "echo")
    assert done.returncode == 1
    assert "FAIL  a topic is heard" in done.stdout
