"""Programs that define a node and do not run it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.runtime.mistakes.unrun import advice
from tests.cases import slow
from tests.conftest import LIMIT

TALK = "from graphflow import Node\n\nclass Talk(Node):\n    pass\n"


@slow
@pytest.mark.parametrize(
    ("more", "is_told"),
    [
        ("", True),
        ("talk = Talk()\nprint('', end=talk.namespace[:0])\n", False),
        ("import graphflow\nif False:\n    graphflow.run(Talk)\n", False),
        ("def helper():\n    pass\n", True),
    ],
)
def test_a_program_that_ends(tmp_path: Path, more: str, is_told: bool) -> None:
    """The remark explains how to run it, unless the program made a node or contains a call that runs one."""
    (tmp_path / "talk.py").write_text(TALK + more)
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    way = "as its last lines: import graphflow; graphflow.run(Talk)"
    told = f"talk.py defines Talk, but runs nothing: graphflow run talk.py, or {way}\n"
    assert done.returncode == 0
    assert done.stderr == (told if is_told else "")


def test_a_parameter_in_the_body_of_a_class(tmp_path: Path) -> None:
    """Python has shown the error; the remedy follows it."""
    (tmp_path / "talk.py").write_text(
        "from graphflow import Node, Param\n\nclass Talk(Node):\n    half = Param(1.0) / 2\n"
    )
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 1
    assert "talk.py:4: a Param has its value on a node: compute with it" in done.stderr.splitlines()[-1]


@slow
@pytest.mark.parametrize("made", ["class Talk(Node): ...", "from talks import Talk"])
def test_a_main_that_nothing_calls(tmp_path: Path, made: str) -> None:
    """It gets the remark, wherever its nodes come from."""
    (tmp_path / "talks.py").write_text(TALK)
    (tmp_path / "talk.py").write_text(
        f"import graphflow\nfrom graphflow import Node\n\n{made}\n\ndef main():\n    graphflow.run(Talk)\n"
    )
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    told = "talk.py:6: main() is defined and never called; add as the last line: if __name__ == '__main__': main()\n"
    assert done.returncode == 0
    assert done.stderr == told


@slow
@pytest.mark.parametrize(("missing", "is_told"), [("arms.geometry", True), ("geometry", False)])
def test_a_file_of_a_package(tmp_path: Path, missing: str, is_told: bool) -> None:
    """It is run as a module, where it imports others of its package."""
    (tmp_path / "arms").mkdir()
    (tmp_path / "arms" / "lift.py").write_text(f"from graphflow import Node\nfrom {missing} import clamp\n")
    program = [sys.executable, "arms/lift.py"]
    done = subprocess.run(program, cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    told = f"to run a file of arms, which imports arms: graphflow run arms.lift, in {tmp_path.resolve()}\n"
    assert done.stderr.endswith(told) is is_told
    assert done.stderr.count("graphflow run") == is_told
    lines = ("from graphflow import Node", f"from {missing} import clamp", "asyncio.run(main())", "")
    (tmp_path / "arms" / "lift.py").write_text("\n".join(lines))
    done = subprocess.run(program, cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    assert done.stderr.endswith(told.replace("graphflow run", "python -m")) is is_told


@slow
def test_a_name_that_is_not_there(tmp_path: Path) -> None:
    """What Python says of it is completed."""
    (tmp_path / "talk.py").write_text("from graphflow import Node\n\nclass N(Node):\n    half = self.rate\n")
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    assert done.stderr.endswith("talk.py:4: a class body has no self: write rate\n")


@slow
def test_an_error_is_enough(tmp_path: Path) -> None:
    """A program that failed gets no remark."""
    (tmp_path / "talk.py").write_text(f"{TALK}1 / 0\n")
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    assert done.stderr.endswith("ZeroDivisionError: division by zero\n")


def test_advice(tmp_path: Path) -> None:
    """With several classes, the command must name one; a missing file gets no remark."""
    file = tmp_path / "talk.py"
    assert advice(file, ["A"]) == ""
    file.write_text(TALK)
    assert "graphflow run MODULE:A, or" in advice(file, ["A", "B"])
    main = '\n\nif __name__ == "__main__":\n    # says its area\n    '
    file.write_text(f"{TALK}{main}print(area())\n")
    assert advice(file, ["A"]) == ""
    file.write_text(f"{TALK}{main}A\n")
    assert "runs nothing" in advice(file, ["A"])
    file.write_text("\ufeffdef main():\n    pass\n", encoding="utf-8")
    assert "main() is defined and never called" in advice(file, []), "a byte order mark is no part of the text"


@slow
@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("Talk()\n", "talk.py:5: Talk() makes a node and does not run it; write: graphflow.run(Talk)\n"),
        (
            "def main():\n    Talk().run()\n\nif __name__ == '__main__':\n    Talk()\n",
            "talk.py:9: Talk() makes a node and does not run it; write: main()\n",
        ),
        ("import asyncio, graphflow\nasyncio.run(asyncio.sleep(0))\nTalk()\nprint(end='')\n", ""),
    ],
)
def test_a_node_that_is_made_and_not_run(tmp_path: Path, more: str, told: str) -> None:
    """It is told with its line, even if some function would run another; a program that goes on is not told."""
    (tmp_path / "talk.py").write_text(TALK + more)
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 0
    assert done.stderr == told
