"""Folders that the environment names."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow import folders
from graphflow.supervisor import rundir


def test_where_the_state_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """In XDG_STATE_HOME, or the home's own folder; a relative one counts as none."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", "/s")
    assert folders.state_root() == Path("/s/graphflow")
    for given in ("", "here"):
        monkeypatch.setenv("XDG_STATE_HOME", given)
        assert folders.state_root() == tmp_path / ".local/state/graphflow"


def test_the_newest_logs_are_where_a_run_puts_them(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The name is known before the run is."""
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    made = rundir.open_logs("lab", "2026-01-01-00-00-00-1")
    assert made.parent == folders.newest_logs("lab").parent
