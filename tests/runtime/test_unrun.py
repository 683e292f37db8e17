"""Programs that define a node and run nothing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.runtime.unrun import advice
from tests.conftest import LIMIT

TALK = "from graphflow import Node\n\nclass Talk(Node):\n    pass\n"


@pytest.mark.parametrize(
    ("more", "is_told"),
    [
        ("", True),
        ("Talk()\n", False),
        ("import graphflow\nif False:\n    graphflow.run(Talk)\n", False),
    ],
)
def test_a_program_that_ends(tmp_path: Path, more: str, is_told: bool) -> None:
    """It is told how to run what it defines, unless it made a node or has words that run one."""
    (tmp_path / "talk.py").write_text(TALK + more)
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    told = "talk.py defines Talk, and runs nothing: graphflow run talk.py, or as its last line: graphflow.run(Talk)\n"
    assert done.returncode == 0
    assert done.stderr == (told if is_told else "")


def test_an_error_is_enough(tmp_path: Path) -> None:
    """A program that failed has said why it ran nothing."""
    (tmp_path / "talk.py").write_text(f"{TALK}1 / 0\n")
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    assert done.stderr.endswith("ZeroDivisionError: division by zero\n")


def test_advice(tmp_path: Path) -> None:
    """Of several classes one has to be named; a file that is gone says nothing."""
    file = tmp_path / "talk.py"
    assert advice(file, ["A"]) == ""
    file.write_text(TALK)
    assert "graphflow run MODULE:A, or" in advice(file, ["A", "B"])
