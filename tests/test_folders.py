"""Folders that the environment names."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from graphflow import folders
from graphflow.errors import SupervisorError
from graphflow.supervisor import rundir


def test_where_the_state_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """In XDG_STATE_HOME, or the home's own folder; a relative one counts as none."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", "/s")
    assert folders.state_root() == Path("/s/graphflow")
    for given in ("", "here"):
        monkeypatch.setenv("XDG_STATE_HOME", given)
        assert folders.state_root() == tmp_path / ".local/state/graphflow"


def test_without_a_home(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """As in a container, whose user is a mere number: a private folder, where the run directories are, too."""

    def unknown(uid: int) -> None:
        raise KeyError(uid)

    monkeypatch.delenv("HOME", raising=False)
    monkeypatch.delenv("XDG_STATE_HOME", raising=False)
    monkeypatch.setattr("pwd.getpwuid", unknown)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert folders.home() is None
    root = folders.state_root()
    assert root == tmp_path / f"graphflow-{os.getuid()}" / "state"
    assert root.parent.stat().st_mode & 0o777 == 0o700

    monkeypatch.setattr("graphflow.folders.user_id", lambda: os.getuid() + 1)
    (tmp_path / f"graphflow-{os.getuid() + 1}").symlink_to(tmp_path)
    with pytest.raises(SupervisorError, match="belongs to another user; set XDG_STATE_HOME to a folder of your own"):
        folders.state_root()


def test_the_newest_logs_are_where_a_run_puts_them(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The name is known before the run is."""
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    made = rundir.open_logs("lab", "2026-01-01-00-00-00-1")
    assert made.parent == folders.newest_logs("lab").parent


def test_a_folder_of_another_user(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It is refused: its owner could read or replace the files."""
    folders.make_private(tmp_path / "own", "A")
    monkeypatch.setattr(folders, "user_id", lambda: os.getuid() + 1)
    with pytest.raises(SupervisorError, match="own belongs to another user; set A to a folder of your own"):
        folders.make_private(tmp_path / "own", "A")
