"""The rate of a topic."""

from __future__ import annotations

import pytest

from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_numbers_and_silence(graph: Graph) -> None:
    """The view shows rate, shortest and longest gap, jitter and losses; and silence as such."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("hz", "/chatter"), graph=graph) as s:
        await s.look()
        await s.until("no message yet")
        await graph.settle()
        for _ in range(5):
            node.chatter.publish(String(data="x"))
            await graph.settle()
        await s.look()
        await s.until("average rate")
        await s.until("over 5 messages")
        await s.until("0 lost on the way")
        s.view._monitor.arrivals.clear()  # type: ignore[attr-defined]
        await s.look()
        await s.until("nothing for 5 s, 5 messages before")
