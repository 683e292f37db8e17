"""The words of a project's source."""

from __future__ import annotations

import ast
import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.runtime.mistakes.source import project_words
from graphflow.runtime.mistakes.source.project_words import is_in_other_files, other_modules

NAME = "words_of_another_module"


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


@pytest.fixture
def project(tmp_path: Path) -> Iterator[Path]:
    """A folder whose list of files is not kept for later tests."""
    yield tmp_path
    project_words._files.cache_clear()


def write(file: Path, text: str = "robot.drive()") -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


@pytest.mark.parametrize(
    ("file", "is_found"),
    [
        ("tests/test_a.py", True),
        ("a/b/c/d.py", True),
        ("a/b/c/d/e.py", False),
        (".cache/a.py", False),
        ("venv/lib/a.py", False),
        ("own.py", False),
        ("a.txt", False),
    ],
)
def test_other_files_that_nothing_has_loaded(project: Path, file: str, is_found: bool) -> None:
    """The project's own files are searched, a few levels deep."""
    write(project / file)
    assert is_in_other_files(str(project / "own.py"), "drive") is is_found
    assert not is_in_other_files(str(project / "own.py"), "driv")


@pytest.mark.parametrize("text", ["graphflow.run(Robot)", "await graph.run(Robot())"])
def test_calls_that_are_no_methods_of_a_node(project: Path, text: str) -> None:
    """Those of the module and of a test's graph have names that a method may have, too."""
    write(project / "main.py", text)
    assert not is_in_other_files(str(project / "own.py"), "run")
    project_words._files.cache_clear()
    write(project / "other.py", "my_graph.run()")
    assert is_in_other_files(str(project / "own.py"), "run")


def test_a_large_file(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file of more than the bound is not searched, and the text of a smaller one is not kept."""
    write(project / "a.py")
    own = str(project / "own.py")
    assert is_in_other_files(own, "drive")
    write(project / "a.py", "robot.stop()")
    assert not is_in_other_files(own, "drive")
    monkeypatch.setattr(project_words, "SIZE_BOUND", 5)
    assert not is_in_other_files(own, "stop")


@pytest.mark.parametrize(("bound", "most"), [("FILES_BOUND", 2), ("FOLDERS_BOUND", 1)])
def test_a_folder_with_many_files(project: Path, monkeypatch: pytest.MonkeyPatch, bound: str, most: int) -> None:
    """Such a folder is searched in part, since it may be anybody's home."""
    for number in range(4):
        write(project / f"a{number}.py", "pass")
    write(project / "b" / "z.py")
    monkeypatch.setattr(project_words, bound, most)
    assert not is_in_other_files(str(project / "own.py"), "drive")
