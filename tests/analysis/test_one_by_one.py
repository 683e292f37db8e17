"""Programs that run nodes one after the other."""

from __future__ import annotations

import sys
import textwrap
from pathlib import Path
from types import SimpleNamespace

import pytest

from graphflow.analysis.one_by_one import one_by_one


def told(program: str, folder: Path) -> list[str]:
    """What is said in each call of `run` that a program makes."""
    file = folder / "two.py"
    file.write_text(textwrap.dedent(program))
    found: list[str] = []

    def run(*_: object) -> None:
        found.append(one_by_one(sys._getframe(1)))

    code = compile(file.read_text(), str(file), "exec")
    exec(code, {"graphflow": SimpleNamespace(run=run), "run": run, "A": "A", "B": "B", "__name__": "__main__"})
    return found


@pytest.mark.parametrize(
    ("program", "text"),
    [
        (
            "graphflow.run(A)\ngraphflow.run(B)\n",
            "two.py:1: graphflow.run(B) begins only when this has ended; to run them together write "
            "graphflow.run(A, B)",
        ),
        (
            "if __name__ == '__main__':\n    run(\n        A)\n    print()\n    run(B, B)\n",
            "two.py:2: run(B, B) begins only when this has ended; to run them together write run(A, B, B)",
        ),
        (
            "def main():\n    graphflow.run(A)\n    graphflow.run(B)\n\nmain()\n",
            "two.py:2: graphflow.run(B) begins only when this has ended; to run them together write "
            "graphflow.run(A, B)",
        ),
        (
            "graphflow.run(A)  # which can stop the robot\ngraphflow.run(B)\n",
            "two.py:1: graphflow.run(B) begins only when this has ended; to run them together write "
            "graphflow.run(A, B)",
        ),
        (
            "for cls in (A, B):\n    graphflow.run(cls)\n",
            "two.py:2: the next one begins only when this has ended; to run them together write graphflow.run(*(A, B))",
        ),
    ],
)
def test_the_second_comes_too_late(tmp_path: Path, program: str, text: str) -> None:
    """Told where the first is run, with the call that runs both."""
    assert told(program, tmp_path)[0] == text


@pytest.mark.parametrize(
    "program",
    [
        "graphflow.run(A)\nprint('done')\n",
        "graphflow.run(A, B)\n",
        "if A:\n    graphflow.run(A)\nelse:\n    graphflow.run(B)\n",
        "graphflow.run(A)\ngraphflow.run(B)\n# A calls self.shutdown() when it is done\n",
        "import subprocess\ngraphflow.run(A)\nsubprocess.run(['true'])\n",
        "for again in range(3):\n    graphflow.run(A)\n",
        "def one(): graphflow.run(A)\ndef two(): graphflow.run(B)\none()\n",
    ],
)
def test_what_is_meant_so(tmp_path: Path, program: str) -> None:
    """One call, one of two, nodes that end by themselves, other functions of that name."""
    assert set(told(program, tmp_path)) == {""}


def test_a_program_without_source() -> None:
    """Nothing is said of it."""
    assert one_by_one(None) == ""
    space: dict[str, object] = {"say": lambda: one_by_one(sys._getframe(1))}
    exec("text = say(); run = len; run('')", space)
    assert space["text"] == ""
