"""Files that hide modules of Python."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from graphflow.analysis.hidden_stdlib import hiding_file
from tests.conftest import PROJECT

TALKER = "from graphflow import Node\n\n\nclass Talker(Node): ...\n"


@pytest.mark.real
@pytest.mark.parametrize(("program", "hides"), [("queue.py", "queue"), ("random.py", "random"), ("main.py", "queue")])
def test_a_program_beside_one(tmp_path: Path, program: str, hides: str) -> None:
    """It is named, without frames of graphflow's own modules."""
    for name in {program, f"{hides}.py"}:
        (tmp_path / name).write_text(TALKER)
    environment = {**os.environ, "PYTHONPATH": str(PROJECT)}
    ended = subprocess.run([sys.executable, program], cwd=tmp_path, env=environment, capture_output=True, text=True)
    told = f"ImportError: {hides}.py hides Python's module {hides}: rename it, as in my_{hides}.py"
    assert ended.stderr.splitlines()[-1] == told
    assert "runtime" not in ended.stderr


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of the program."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys.modules["__main__"], "__file__", str(tmp_path / "main.py"), raising=False)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    return tmp_path


def _imported(monkeypatch: pytest.MonkeyPatch, name: str, file: Path) -> None:
    module = ModuleType(name)
    module.__file__ = str(file)
    monkeypatch.setitem(sys.modules, name, module)


def test_a_file_or_a_package(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is named with its new name."""
    assert hiding_file(ImportError("no")) == ""
    _imported(monkeypatch, "wave", folder / "wave" / "__init__.py")
    told = "wave/__init__.py hides Python's module wave: rename it, as in my_wave"
    assert hiding_file(ImportError("no")) == told
    monkeypatch.undo()
    assert hiding_file(ImportError(told)) == told


@pytest.mark.parametrize("name", ["helper", "wave"])
def test_other_files(folder: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Are not named: modules of another name, and those of another folder."""
    _imported(monkeypatch, name, folder / f"{name}.py" if name == "helper" else folder / "lib" / "wave.py")
    assert hiding_file(AttributeError("no")) == ""
