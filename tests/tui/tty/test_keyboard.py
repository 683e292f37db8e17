"""Keys typed faster than the console can follow: nothing is lost, and each goes where its predecessors led."""

from __future__ import annotations

import pytest
from textual import events
from textual.widgets import Input

from graphflow.tui.panes import Content
from tests.tui.stage import Stage, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def type_ahead(s: Stage, *keys: str) -> None:
    """Have all keys there at once, and wait until the last is done."""
    for key in keys:
        s.console.post_message(events.Key(key, key if len(key) == 1 else None))
    await s.pilot.pause()
    await s.until(lambda: s.console.keyboard.is_quiet and bool(s.text.strip()))  # a new dialog is drawn a moment later


async def test_into_a_dialog_and_out_of_it() -> None:
    """The dialog gets what was typed for it, and the pane what follows its enter."""
    async with stage(Content("nodes")) as s:
        await type_ahead(s, "ctrl+b", "c", *"topics", "enter", "ctrl+b", "0", "s")
        assert [w.name for w in s.console.windows.windows.values()] == ["nodes", "topics"]
        assert s.console.windows.current == 0
        assert "Stop /talker?" in s.text or "Stop /arm/left?" in s.text


async def test_letters_and_keys_that_are_bound() -> None:
    """In the order in which they were typed, a paste among them."""
    async with stage(Content("prompt")) as s:
        for key in ("a", "b", "left", "c", "home", "d"):
            s.console.post_message(events.Key(key, key if len(key) == 1 else None))
        s.console.post_message(events.Paste("xy"))
        await type_ahead(s, "end", "z")
        assert s.view.query_one("Input.line", Input).value == "dxyacbz"


async def test_after_a_pane_that_goes() -> None:
    """What had the focus is gone before the key is done; the next one goes to the pane that follows."""
    async with stage(Content("nodes")) as s:
        await s.prefix("percent_sign")
        await type_ahead(s, "ctrl+b", "x", "s")
        assert len(s.console.window.numbers) == 1
        assert "Stop /" in s.text


async def test_focus_that_was_lost() -> None:
    """When what has the focus is hidden, the next key brings it back to the pane."""
    async with stage(Content("nodes")) as s:
        s.console.screen.set_focus(None)
        await s.press("s")
        await s.until("Stop /")
