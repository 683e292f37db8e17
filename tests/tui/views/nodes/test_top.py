"""Resource use of processes."""

from __future__ import annotations

import os

import pytest

from graphflow.tui.panes import Content
from tests.tui.stage import Supervised, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_a_row_a_process() -> None:
    """Each process has a row with all its nodes, the supervisor included; ended ones are left out."""
    async with stage(Content("top"), nodes=("/a", "/b", "/gone")) as s:
        supervision = s.console.hub.supervision
        assert isinstance(supervision, Supervised)
        supervision.nodes["/a"]["pid"] = supervision.nodes["/b"]["pid"] = os.getpid()
        supervision.nodes["/gone"] |= {"pid": os.getppid(), "state": "ended"}
        await s.look()
        await s.until("/a, /b")
        await s.until("the supervisor")
        assert "/gone" not in s.text
        await s.press("M")
        await s.until("/a, /b")
