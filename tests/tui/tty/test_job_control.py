"""The console as a job of its shell; `test_terminal` stops and continues it in a real one."""

from __future__ import annotations

import pytest

from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_without_a_shell() -> None:
    """As in a browser: it says so, and nothing is stopped."""
    async with stage() as s:
        assert not s.console.job_control.has_shell
        await s.press("ctrl+z")
        await s.until("this console was not started from a shell")
