"""The bottom lines: available keys, windows, states; clicks on them."""

from __future__ import annotations

import time
from typing import Any, cast

import pytest

from graphflow.machines.lifecycle import LifecycleState
from graphflow.machines.process import State
from graphflow.tui.feeds.supervision import NodeRow
from graphflow.tui.panes import Content
from graphflow.tui.widgets.bars import MARKS, SEEN_AFTER, displayed_state
from tests.cases import slow
from tests.tui.stage import record, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def test_every_state_has_a_mark() -> None:
    """States of processes and lifecycles have marks, as have nodes of others; each bad state has a mark of its own."""
    states = {state.value for state in State} | {state.label for state in LifecycleState if state.is_primary and state}
    assert states | {"failed", "given_up", "lost", "unresponsive", "foreign", "deadlock"} == set(MARKS)
    bad = [mark.glyph for mark in MARKS.values() if mark.colours == "bad"]
    assert len(bad) == len(set(bad)) == 5


def test_the_word_of_a_node() -> None:
    """A deadlock takes precedence over a running process, and so does a lifecycle state."""
    row = cast("NodeRow", {"node": "/a", "state": "ready", "lifecycle": "inactive"})
    assert displayed_state(row, {"/a"}) == "deadlock"
    assert displayed_state(row, ()) == "inactive"
    assert displayed_state({**row, "state": "failed", "lifecycle": ""}, {"/a"}) == "failed"


@slow
async def test_the_bottom_lines_on_80_columns() -> None:
    """The keys of the focused view, and the two most important ones."""
    async with stage(Content("log"), Content("nodes"), size=(80, 24)) as s:
        hints, status = s.text.split("\n")[-2:]
        assert "/ filter" in hints
        assert "[lab]  0:log*  1:nodes" in status
        assert status.endswith("●2  ^b ? help  ^b d leave")


@slow
async def test_what_is_wrong_with_the_graph() -> None:
    """Unseen errors are shown with their key, and so are races."""
    async with stage(Content("nodes"), size=(110, 24)) as s:
        s.console.hub.logs.add([record("RACE: an update of self.x is lost", level=2), record("bad", level=3)])
        await s.look()
        assert "E1 ^b e ⇄1 RACE ^b g" in s.text.split("\n")[-1]


@slow
async def test_a_click_on_a_window_opens_it() -> None:
    """Windows can be chosen by mouse."""
    async with stage(Content("log"), Content("nodes")) as s:
        at = s.text.split("\n")[-1].index("1:nodes")
        await s.pilot.click(type(s.console.status), offset=(at + 1, 0))
        assert s.console.windows.current == 1


@slow
async def test_many_windows_leave_room_for_the_states() -> None:
    """Windows around the current one are shown, with clickable marks for the others."""
    async with stage(*[Content("topics")] * 12, size=(80, 24)) as s:
        status = s.text.split("\n")[-1]
        assert status.startswith(" [lab]  0:topics*  1:topics ")
        assert ":topics >" in status
        assert status.endswith(" ●2")
        s.console.deadlocks = 1
        s.console.commands.go_to_window(7)
        await s.until(lambda: "7:topics*" in s.text.split("\n")[-1])
        status = s.text.split("\n")[-1]
        assert status.endswith("●2 ✖ 1 DEADLOCK ^b g")
        assert status.count(":topics") == 4
        await s.pilot.click(type(s.console.status), offset=(status.index("<"), 0))
        assert s.console.windows.current == int(status[status.index("<") + 2]) - 1


@slow
async def test_clicks_on_what_can_be_pressed() -> None:
    """The view's keys, help and leaving can be clicked."""
    async with stage(Content("log"), size=(100, 24)) as s:
        await s.pilot.pause()
        hints = s.text.split("\n")[-2]
        await s.pilot.click(type(s.console.hints), offset=(hints.index("filter"), 0))
        await s.until(lambda: "shown" in s.view.query_one("Input").classes)
        status = s.text.split("\n")[-1]
        await s.pilot.click(type(s.console.status), offset=(status.index("help"), 0))
        await s.until("The prefix is ^b")
        await s.press("escape")
        await s.pilot.click(type(s.console.status), offset=(status.index("leave"), 0))
        await s.until(lambda: s.console.return_value == "detach")


@slow
async def test_a_deadlock_is_told_wherever_one_is() -> None:
    """A new deadlock is reported in every view, with the key that shows it."""
    async with stage() as s:
        s.console.deadlocks = 1
        await s.look()
        await s.until("✖ 1 DEADLOCK ^b g")
        s.console.prefix = "ctrl+a"
        await s.look()
        await s.until("✖ 1 DEADLOCK ^a g")


async def test_after_the_end() -> None:
    """The exit code stays visible."""
    async with stage() as s:
        supervision: Any = s.console.hub.supervision
        supervision.exit_code = 1
        await s.look()
        await s.until("ended, exit code 1")


async def test_a_supervisor_that_died() -> None:
    """The states from before its death are not shown as current."""
    async with stage() as s:
        supervision: Any = s.console.hub.supervision
        supervision.is_lost = True
        await s.look()
        await s.until("✖ supervisor gone")


@slow
async def test_what_went_wrong_stays_until_it_is_seen() -> None:
    """Later messages do not replace an unseen error; commands do."""
    async with stage(size=(80, 20)) as s:
        s.console.say("/arm died", bad=True)
        s.console.say("all nodes have ended")
        assert "/arm died" in s.text
        assert "all nodes have ended" in s.console.messages[-1]
        s.console.did("graphflow restart /arm")
        assert "$ graphflow restart /arm" in s.text


@slow
async def test_a_message_that_is_too_long() -> None:
    """A cut message says how to see all of it; a key dismisses it once it has been seen."""
    async with stage(size=(60, 20)) as s:
        s.console.say("word " * 30)
        await s.look()
        assert s.text.split("\n")[-2].endswith("… ^b ~ shows all")
        await s.press("down")
        await s.until("word word")
        s.console.hints.look(time.monotonic() + SEEN_AFTER, pressed=True)
        await s.look()
        assert "word word" not in s.text
