"""The help has every key."""

from __future__ import annotations

import pytest

from graphflow.console.views import VIEWS
from graphflow.tui.commands.actions import console_actions, keys_of
from graphflow.tui.panes import Content
from graphflow.tui.registry import view_class
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_every_action_is_in_it() -> None:
    """The actions of the console and of every view are listed with their titles."""
    async with stage(Content("help")) as s:
        text = "\n".join(row.plain for row in s.view._lines.rows)  # type: ignore[attr-defined]
    for action in console_actions():
        assert f"  {keys_of(action, 'ctrl+b'):22} {action.title}" in text
    for name in VIEWS:
        for action in view_class(name).ACTIONS:
            assert f"  {keys_of(action, 'ctrl+b'):22} {action.title}" in text


@slow
async def test_long_lines_go_on_beside_the_keys() -> None:
    """Lines that do not fit into 80 columns are wrapped."""
    async with stage(Content("nodes"), size=(80, 24)) as s:
        await s.press("f1")
        await s.type("lifecycle set")
        await s.until("set {node} TRANSITION")
        lines = s.text.split("\n")
        keys = next(line for line in lines if "change its life cycle" in line)
        assert next(line for line in lines if "TRANSITION" in line).index("set") == keys.index("change")


@slow
async def test_it_is_found_by_typing() -> None:
    """Keys, titles and commands are searched; the view that opened the help comes first."""
    async with stage(Content("nodes"), size=(100, 40)) as s:
        await s.press("f1")
        await s.until("View nodes")
        lines = [line.strip("│ ") for line in s.text.split("\n")]
        assert lines.index("Leave") > next(i for i, line in enumerate(lines) if line.startswith("View nodes"))
        await s.type("restart")
        await s.until("graphflow restart {node}")
        assert "detach" not in s.text
        await s.type("xyz")
        await s.until("no match for 'restartxyz'")
        await s.press("escape")
        assert len(s.console.screen_stack) == 1
