"""The console's screen: events are shown, views are updated at their rate, several consoles agree."""

from __future__ import annotations

from typing import Any

import pytest
from textual import events
from textual.widgets import Input

from graphflow.tui.panes import Content
from graphflow.tui.widgets.dialogs import AskLine
from tests.cases import slow
from tests.tui.stage import record, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
@pytest.mark.parametrize(
    ("event", "text"),
    [
        ({"event": "announced", "text": "restart /a", "by": "pts/9"}, "restart /a by pts/9"),
        ({"event": "note", "text": "linked to tcp/x"}, "linked to tcp/x"),
        ({"event": "stopping", "reason": "down"}, "stopping (down)"),
        ({"event": "step", "step": "spawn", "ok": False, "text": "/spawn: no"}, "step spawn FAILED: /spawn: no"),
        ({"event": "error", "message": "not ready within 20 s"}, "not ready within 20 s"),
        ({"event": "end", "exit_code": 1}, "the graph has ended, exit code 1; q leaves"),
        ({"event": "lost", "message": "the supervisor has gone"}, "the supervisor has gone; q leaves"),
    ],
)
async def test_what_the_supervisor_says(event: dict[str, Any], text: str) -> None:
    """The message is in the bottom line, and among the messages."""
    async with stage() as s:
        s.console.handle_supervisor_event(event)
        assert text in s.text
        assert text in s.console.messages[-1]


async def test_who_has_stopped_the_graph() -> None:
    """The reason for stopping is repeated at the end."""
    async with stage() as s:
        s.console.handle_supervisor_event({"event": "stopping", "reason": "down, by pts/7"})
        s.console.handle_supervisor_event({"event": "end", "exit_code": 0})
        assert "the graph has ended (down, by pts/7), exit code 0; q leaves" in s.text


@slow
async def test_a_terminal_that_has_lost_the_focus() -> None:
    """A terminal reported out of focus, as by tmux, still focuses the first dialog."""
    async with stage() as s:
        s.console.post_message(events.AppBlur())
        await s.until(lambda: not s.console.app_focus)
        await s.prefix("c")
        await s.type("log")
        await s.press("enter")
        await s.until("1:log*")
        s.console.post_message(events.AppBlur())
        await s.until(lambda: not s.console.app_focus)
        s.console.push_screen(AskLine("Name"))  # at a moment when nobody types
        await s.pilot.pause()
        s.console.post_message(events.AppFocus())
        await s.until(lambda: isinstance(s.console.focused, Input))


async def test_a_crash_is_flagged_until_one_looks() -> None:
    """The window list has a mark, and the bottom line says how to go on."""
    async with stage(Content("log"), Content("nodes")) as s:
        s.console.handle_supervisor_event(
            {"event": "exited", "nodes": ["/arm"], "how": "signal SIGKILL", "unexpected": True}
        )
        assert "^b e shows why: /arm died, signal SIGKILL" in s.text
        assert "0:log*!" in s.text
        await s.prefix("1")
        await s.prefix("0")
        assert "0:log*!" not in s.text


@slow
async def test_logs_are_read_while_the_console_runs() -> None:
    """Logs are read at every update, even if no view shows them."""
    async with stage(Content("log"), records=[record("one")]) as s:
        await s.until("one")
        s.console.hub.logs.add([record("two")])
        await s.until("two")


async def test_windows_are_kept_with_the_run() -> None:
    """Windows are saved after a change and on leaving, with the current content of the views."""
    async with stage(Content("log")) as s:
        await s.press("3")
        s.console.save_layout()
        supervision: Any = s.console.hub.supervision
        kept = [r["layout"] for r in supervision.asked if r["do"] == "keep_layout"]
        assert kept[-1]["windows"][0]["root"]["options"] == {"level": "warn"}


@slow
async def test_a_small_terminal_shows_one_pane() -> None:
    """A terminal too small for two panes shows one."""
    async with stage(Content("nodes"), size=(80, 24)) as s:
        await s.prefix("percent_sign")
        assert len(s.console.workspace.visible_frames) == 2
        await s.pilot.resize_terminal(22, 10)
        await s.until(lambda: len(s.console.workspace.visible_frames) == 1)
        await s.pilot.resize_terminal(80, 24)
        await s.until(lambda: len(s.console.workspace.visible_frames) == 2)
