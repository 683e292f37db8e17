"""The help has every key."""

from __future__ import annotations

import pytest

from graphflow.graph.console import VIEWS
from graphflow.tui.actions import console_actions, keys_of
from graphflow.tui.panes import Content
from graphflow.tui.registry import view_class
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_every_action_is_in_it() -> None:
    """The console's and those of every view, with their titles."""
    async with stage(Content("help")) as s:
        text = "\n".join(row.plain for row in s.view._lines.rows)  # type: ignore[attr-defined]
    for action in console_actions():
        assert f"  {keys_of(action, 'ctrl+b'):22} {action.title}" in text
    for name in VIEWS:
        for action in view_class(name).ACTIONS:
            assert f"  {keys_of(action, 'ctrl+b'):22} {action.title}" in text
