"""A file at a line."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.tui.panes import Content
from graphflow.tui.views import source
from graphflow.tui.views.source import find_file
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_the_line_is_marked_and_on_screen(tmp_path: Path) -> None:
    """The line is marked and visible wherever it is; control characters have no effect."""
    file = tmp_path / "long.py"
    file.write_text("\n".join(f"x{i} = {i}  # \x1b[31m" for i in range(1, 301)))
    async with stage(Content("source", f"{file}:200"), size=(80, 20)) as s:
        await s.until("▶200 x200 = 200")
        assert "x300" not in s.text
        assert "\x1b" not in s.text
        await s.press("y")
        assert s.console.clipboard_text == f"{file}:200"


@slow
async def test_the_lines_before_it_are_on_screen(tmp_path: Path) -> None:
    """The lines before it are visible even in a new pane, whose height is known only later."""
    (tmp_path / "long.py").write_text("\n".join(f"x{i} = {i}" for i in range(1, 301)))
    async with stage(Content("nodes"), size=(80, 24)) as s:
        s.view.open("source", f"{tmp_path / 'long.py'}:200")
        await s.until("▶200 x200 = 200")
        await s.until("x197 = 197")
        assert "x203 = 203" in s.text


@slow
async def test_escape_closes_it(tmp_path: Path) -> None:
    """Escape returns to the pane that opened it."""
    (tmp_path / "a.py").write_text("x = 1\n")
    async with stage(Content("nodes")) as s:
        s.view.open("source", f"{tmp_path / 'a.py'}:1")
        await s.until("x = 1")
        await s.press("escape")
        await s.until(lambda: [p.content.view for p in s.console.window.panes()] == ["nodes"])


@slow
async def test_a_file_that_is_not_there() -> None:
    """The view says that the file is missing."""
    async with stage(Content("source", "nowhere.py:3")) as s:
        assert "there is no file nowhere.py:3" in s.text


async def test_the_editor_must_be_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without an editor, the message says what to set."""
    monkeypatch.delenv("EDITOR", raising=False)
    monkeypatch.delenv("VISUAL", raising=False)
    (tmp_path / "a.py").write_text("x = 1\n")
    async with stage(Content("source", f"{tmp_path / 'a.py'}:1")) as s:
        await s.press("e")
        await s.until("set EDITOR")
        monkeypatch.setenv("EDITOR", "no-such-editor --wait")
        await s.press("e")
        await s.until("there is no such program: install it, or export EDITOR=nano")
        monkeypatch.setenv("EDITOR", "'open")
        await s.press("e")
        await s.until("No closing quotation")


def test_files_by_their_name_alone(tmp_path: Path) -> None:
    """A file name without a folder, as in reports, is searched for."""
    (tmp_path / "nodes").mkdir()
    file = tmp_path / "nodes" / "arm.py"
    file.write_text("")
    assert find_file("arm.py", [tmp_path]) == file
    assert find_file("nodes/arm.py", [tmp_path]) == file
    assert find_file(str(file), []) is None or find_file(str(file), [Path("/")]) == file
    assert find_file("leg.py", [tmp_path]) is None


async def test_a_long_file_is_cut(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Colouring it takes time in proportion."""
    monkeypatch.setattr(source, "LONGEST", 12)
    (tmp_path / "a.py").write_text("first = 1\nsecond = 2\n")
    async with stage(Content("source", f"{tmp_path / 'a.py'}:1")) as s:
        await s.until("first = 1")
        assert "second" not in s.text


def test_a_file_among_too_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The search for a name alone gives up."""
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.py").write_text("")
    last = [*tmp_path.rglob("*.py")][-1]
    assert find_file(last.name, [tmp_path]) == last
    inner = tmp_path / "inner"
    inner.mkdir()
    last.rename(inner / last.name)
    monkeypatch.setattr(source, "FILES_BOUND", -1)
    assert find_file(last.name, [tmp_path]) is None
