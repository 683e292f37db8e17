"""Messages to the user, and leaving."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.tui.panes import Content
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_messages_are_kept() -> None:
    """The last five hundred messages are kept, commands among them."""
    async with stage() as s:
        for i in range(600):
            s.console.say(f"message {i}")
        s.console.did("graphflow ps")
        assert len(s.console.messages) == 500
        assert s.console.messages[-1].endswith("$ graphflow ps")
        assert s.console.last_shell == "graphflow ps"


async def test_leaving_keeps_the_windows_and_lets_go() -> None:
    """Leaving closes the views and saves the windows."""
    async with stage(Content("log")) as s:
        await s.console.leave("detach")
        supervision: Any = s.console.hub.supervision
        assert supervision.asked[-1]["do"] == "keep_layout"
        assert s.console.return_value == "detach"
