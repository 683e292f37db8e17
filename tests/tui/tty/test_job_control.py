"""The console as a job of its shell; `test_terminal` suspends and resumes it in a real one."""

from __future__ import annotations

import pytest

from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_without_a_shell() -> None:
    """Without a shell, as in a browser, the console says so and is not suspended."""
    async with stage() as s:
        assert not s.console.job_control.has_shell
        await s.press("ctrl+z")
        await s.until("this console was not started from a shell")
