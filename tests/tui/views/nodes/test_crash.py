"""The evidence of a crash, and the restart."""

from __future__ import annotations

import pytest

from graphflow.tui.panes import Content
from graphflow.tui.views.nodes.crash import traceback_of
from tests.cases import slow
from tests.tui.stage import Supervised, record, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

TRACE = [
    "starting",
    "Traceback (most recent call last):",
    '  File "/usr/lib/python3/asyncio/tasks.py", line 1, in run',
    '  File "/home/me/lab/nodes/arm.py", line 41, in tick',
    "    1 / 0",
    "ZeroDivisionError: division by zero",
    "bye",
]


@slow
async def test_the_evidence() -> None:
    """Exit status, traceback with the user's own lines marked, and last output are shown; r restarts."""
    records = [record(text, "/talker", 3 if i else 1, number=i) for i, text in enumerate(TRACE)]
    async with stage(Content("crash", "/talker"), records=records) as s:
        supervision = s.console.hub.supervision
        assert isinstance(supervision, Supervised)
        supervision.nodes["/talker"] |= {"state": "failed", "detail": "exit code 70 (an error in the node)"}
        await s.look()
        await s.until("✖ /talker failed")
        await s.until("exit code 70")
        await s.until('▌   File "/home/me/lab/nodes/arm.py", line 41, in tick')
        assert '▌   File "/usr/lib' not in s.text
        assert "bye" in s.text
        await s.press("r")
        assert s.asked == [{"do": "restart", "node": "/talker"}]
        await s.press("enter")
        assert str(s.view.content) == "source /home/me/lab/nodes/arm.py:41"


def test_the_last_traceback() -> None:
    """The last traceback extends from its first line to the error; empty if there is none."""
    records = [record(text) for text in ("Traceback (most recent call last):", "  old", "Old: x", *TRACE)]
    assert [r.text for r in traceback_of(records)] == TRACE[1:6]
    assert traceback_of([record("fine")]) == []
