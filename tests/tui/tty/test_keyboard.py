"""Keys typed faster than the console can follow: none is lost, and each goes where the ones before it led."""

from __future__ import annotations

import asyncio
import time

import pytest
from textual import events
from textual.widgets import Input

from graphflow.tui.panes import Content
from graphflow.tui.tty import keyboard
from tests.cases import slow
from tests.tui.stage import Stage, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def type_ahead(s: Stage, *keys: str) -> None:
    """Post all keys at once, and wait until the last has taken effect."""
    for key in keys:
        s.console.post_message(events.Key(key, key if len(key) == 1 else None))
    await s.pilot.pause()
    await s.until(lambda: s.console.keyboard.is_quiet and bool(s.text.strip()))  # a new dialog is drawn a moment later


@slow
async def test_into_a_dialog_and_out_of_it() -> None:
    """A dialog gets the keys typed for it, and the pane those after its enter."""
    async with stage(Content("nodes")) as s:
        await type_ahead(s, "ctrl+b", "c", *"topics", "enter", "ctrl+b", "0", "s")
        assert [w.name for w in s.console.windows.windows.values()] == ["nodes", "topics"]
        assert s.console.windows.current == 0
        assert "Stop /talker?" in s.text or "Stop /arm/left?" in s.text


async def test_letters_and_keys_that_are_bound() -> None:
    """Letters and bound keys keep their order, with a paste among them."""
    async with stage(Content("prompt")) as s:
        for key in ("a", "b", "left", "c", "home", "d"):
            s.console.post_message(events.Key(key, key if len(key) == 1 else None))
        s.console.post_message(events.Paste("xy"))
        await type_ahead(s, "end", "z")
        assert s.view.query_one("Input.line", Input).value == "dxyacbz"


@slow
async def test_after_a_pane_that_goes() -> None:
    """A key may remove its own target; the next key goes to the following pane."""
    async with stage(Content("nodes")) as s:
        await s.prefix("percent_sign")
        await type_ahead(s, "ctrl+b", "x", "s")
        assert len(s.console.window.numbers) == 1
        assert "Stop /" in s.text


@slow
async def test_focus_that_was_lost() -> None:
    """If the focused widget is hidden, the next key restores the focus of the pane."""
    async with stage(Content("nodes")) as s:
        s.console.screen.set_focus(None)
        await s.press("s")
        await s.until("Stop /")


async def test_more_keys_than_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """The oldest are dropped, as when something has fallen on the keyboard."""
    monkeypatch.setattr(keyboard, "QUEUE_BOUND", 2)
    async with stage(Content("nodes")) as s:
        queue = keyboard.Keyboard(s.console, s.console.on_event, lambda _: None)._queue
        for key in "abc":
            queue.append(events.Key(key, key))
        assert [each.key for each in queue if isinstance(each, events.Key)] == ["b", "c"]


@slow
async def test_a_console_that_is_slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """However long its turns take, a dialog gets the keys that are typed for it."""
    monkeypatch.setattr(keyboard, "DONE_AFTER", 60.0)  # the machine may be slow itself

    async def take_long(s: Stage) -> None:
        """Have the console believe that each of its turns takes half of that."""
        while True:
            await s.console.keyboard.look(time.monotonic() + 30.0)
            await asyncio.sleep(0)

    async with stage(Content("nodes")) as s:
        turns = asyncio.create_task(take_long(s))
        await type_ahead(s, "ctrl+b", "colon", *"ab")
        assert s.console.screen.query_one(Input).value == "ab"
        turns.cancel()
