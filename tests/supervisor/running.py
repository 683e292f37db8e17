"""Graphs of a user's own project that run, as tests of the supervisor see them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

from tests.conftest import PROGRAMS, Machine, alive

GOOD = "nodes:\n  /a: {class: nodes.lab:Good}\n  /b: {class: nodes.lab:Good, env: {COLOUR: red}}\n"


def make_project(root: Path) -> Path:
    """A user's own project: nodes that misbehave, each in one way."""
    (root / "nodes").mkdir(parents=True)
    (root / "pyproject.toml").touch()
    shutil.copy(PROGRAMS / "supervisor" / "lab.py", root / "nodes")
    return root


def write(project: Path, text: str, name: str = "lab.yaml") -> str:
    (project / name).write_text(text)
    return name


def rows(machine: Machine) -> dict[str, dict[str, Any]]:
    return {row["node"]: row for row in json.loads(machine.look("ps", "--json").splitlines()[0])}


def supervisor_of(machine: Machine) -> dict[str, Any]:
    (file,) = machine.run_directory.glob("graphflow/*/*/run.json")
    run: dict[str, Any] = json.loads(file.read_text())
    return run


def nothing_is_left(machine: Machine, pids: list[int]) -> None:
    machine.until(lambda: not any(alive(pid) for pid in pids), "all processes are gone")
    machine.until(lambda: not list(machine.run_directory.glob("graphflow/*/*")), "the run directory is removed")
