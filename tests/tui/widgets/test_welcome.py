"""The line for newcomers."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.tui.widgets.welcome import is_first_visit
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_it_is_put_away_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Escape hides the line, also in later consoles."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert is_first_visit()
    async with stage(size=(80, 24)) as s:
        s.console.welcome.display = True
        await s.pilot.pause()
        assert "New here? tab next pane  ^b d leave, all runs on  ^c stop...  ^p menu  esc hide" in s.text
        await s.press("escape")
        assert "New here?" not in s.text
        assert not is_first_visit()


async def test_nowhere_to_remember_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a place to store it, the line is hidden for now."""
    (tmp_path / "graphflow").touch()
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    async with stage(size=(80, 24)) as s:
        s.console.welcome.display = True
        await s.press("escape")
        assert not s.console.welcome.display
        assert is_first_visit()
