"""The clipboard: the choice of program, and the messages if there is none or it fails."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.tui.panes import Content
from graphflow.tui.tty import clipboard
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The only folder on the PATH; no terminal, no display."""
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    for name in ("TMUX", "WAYLAND_DISPLAY", "DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


def tool(folder: Path, name: str, script: str) -> None:
    (folder / name).write_text(f"#!/bin/sh\n{script}\n")
    (folder / name).chmod(0o755)


def test_which_program(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The program of the user's terminal or display is chosen if it is installed."""
    for name in ("tmux", "wl-copy", "xclip"):
        tool(folder, name, "")
    assert clipboard.program() == ()
    monkeypatch.setenv("DISPLAY", ":0")
    assert clipboard.program() == ("xclip", "-selection", "clipboard")
    monkeypatch.setenv("WAYLAND_DISPLAY", "wayland-0")
    assert clipboard.program() == ("wl-copy",)
    monkeypatch.setenv("TMUX", "x")
    assert clipboard.program() == ("tmux", "load-buffer", "-w", "-")
    (folder / "tmux").unlink()
    monkeypatch.setenv("PATH", str(folder))
    assert clipboard.program() == ("wl-copy",)


def test_a_copy(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The program reads the text; its failure is reported."""
    tool(folder, "keep", f"cat > {folder}/kept")
    assert clipboard.copy_with(("keep",), "a b") == ""
    assert (folder / "kept").read_text() == "a b"
    tool(folder, "fail", "exit 3")
    assert clipboard.copy_with(("fail",), "") == "fail ended with 3"
    assert "nothere" in clipboard.copy_with(("nothere",), "")
    monkeypatch.setattr(clipboard, "LIMIT", 0.1)
    tool(folder, "hang", "exec sleep 5")
    assert "timed out" in clipboard.copy_with(("hang",), "")


@slow
async def test_what_is_told(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only an external program confirms the copy."""
    async with stage(Content("nodes")) as s:
        s.console.copy("/talker")
        assert "copied /talker, if the terminal lets programs copy; ^b ] pastes it here" in s.text
        tool(folder, "xclip", f"cat > {folder}/kept")
        monkeypatch.setenv("DISPLAY", ":0")
        s.console.copy("/arm", "the name")
        await s.until("copied the name")
        assert (folder / "kept").read_text() == "/arm"
        tool(folder, "xclip", "exit 1")
        s.console.copy("/arm")
        await s.until("not copied: xclip ended with 1")
