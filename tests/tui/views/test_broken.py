"""The substitute for a view that cannot be shown."""

from __future__ import annotations

import pytest

from graphflow.tui.panes import Content
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_a_view_that_is_not_there() -> None:
    """The pane says so, with the nearest name; the console goes on."""
    async with stage(Content("turtel")) as s:
        assert "there is no view 'turtel'; did you mean 'turtle'?" in s.text
        await s.prefix("quotation_mark")
        assert len(s.console.window.numbers) == 2
