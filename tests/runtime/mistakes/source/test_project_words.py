"""The words of a project's source."""

from __future__ import annotations

import ast
import importlib.util
import sys
from pathlib import Path

import pytest

from graphflow.runtime.mistakes.source.project_words import other_modules, words_in

NAME = "words_of_another_module"


def test_words_are_what_is_read_and_not_what_is_shown() -> None:
    """Attributes, names and strings; set attributes and the texts of logs are none."""
    module = ast.parse("self.set = self.read\ncall(name, 'given')\nself.log.info('shown')\nprint('shown')")
    assert words_in(module) == {"self", "read", "call", "name", "given", "log", "info", "print"}


def _imported(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Write a module, and have it count as imported."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("use.wanted_word\n")
    spec = importlib.util.spec_from_file_location(NAME, file)
    assert spec is not None
    monkeypatch.setitem(sys.modules, NAME, importlib.util.module_from_spec(spec))


def test_the_other_modules_of_a_project_that_have_a_word(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that are imported, in the folder of the file, but for the file itself."""
    other, own = tmp_path / f"{NAME}.py", tmp_path / "own.py"
    _imported(other, monkeypatch)
    assert [ast.unparse(module) for module in other_modules(str(own), "wanted_word")] == ["use.wanted_word"]
    assert list(other_modules(str(own), "another_word")) == []
    assert list(other_modules(str(other), "wanted_word")) == []


def test_installed_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are none of the project's, though a virtual environment is in its folder."""
    _imported(tmp_path / ".venv/lib/site-packages" / f"{NAME}.py", monkeypatch)
    assert list(other_modules(str(tmp_path / "own.py"), "wanted_word")) == []
