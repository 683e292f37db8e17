"""Run Python launch files, each in a process of its own that records its launch actions."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.launchfiles.recorded import Description

PYTHON_LIMIT = 20.0
"""Seconds that a launch file may run."""


def described(file: Path, name: str, values: Mapping[str, Any] | None) -> Description:
    """Run a launch file; returns its `actions`, and `problems` and `remarks` on its unsupported parts.

    Args:
        name: The file as messages show it.
        values: The arguments that it is started with; None if it is only converted.

    Raises:
        GraphFileError: It failed, or took too long.
    """
    # Through graphflow.rclpy, by which Python finds rclpy and the packages of the file's workspace.
    recorder = ["-m", "graphflow.rclpy", "-m", "graphflow.supervisor.launching.launch_recorder"]
    command = [sys.executable, "-P", *recorder, str(file)]
    command += [] if values is None else [json.dumps(values)]
    try:
        ran = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=PYTHON_LIMIT, check=False)
    except subprocess.TimeoutExpired:
        raise GraphFileError(
            [Problem(Place(name), f"it did not return a launch description within {PYTHON_LIMIT:g} s")]
        ) from None
    if values is not None:  # its output is for the user who starts it
        sys.stderr.write(ran.stderr.decode(errors="replace"))
    try:
        recorded: Description = json.loads(ran.stdout)
    except ValueError:
        last = ran.stderr.decode(errors="replace").strip().rpartition("\n")[2]
        raise GraphFileError([Problem(Place(name), f"it ended without a launch description: {last}")]) from None
    return recorded
