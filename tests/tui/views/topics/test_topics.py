"""The list of topics, with mismatches."""

from __future__ import annotations

import pytest

from graphflow import Node, Publisher, Qos, Subscription
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.qos import Reliability
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Careless(Node):
    """Publishes with a QoS that its listener does not accept."""

    fast = Publisher(String, "scan", Qos(reliability=Reliability.BEST_EFFORT))
    number = Publisher(Int32, "word")


class Careful(Node):
    """Requires reliable messages."""

    scan = Subscription(String, "scan")
    word = Subscription(String, "word")


@slow
async def test_types_and_counts(graph: Graph) -> None:
    """Publishers and subscriptions are counted; hidden topics are shown on request."""
    await graph.start(Talker(), Listener())
    async with stage(Content("topics"), graph=graph) as s:
        await s.until("/chatter")
        [row] = [line for line in s.text.split("\n") if line.startswith(" /chatter")]
        assert row.split() == ["/chatter", "std_msgs/msg/String", "1", "1"]
        assert "_action" not in s.text
        await s.press("a")
        await s.until("/fibonacci/_action/feedback")


async def test_what_does_not_fit_is_said(graph: Graph) -> None:
    """Mismatches of QoS and type are described in the row of the topic."""
    await graph.start(Careless(), Careful())
    async with stage(Content("topics"), graph=graph) as s:
        await s.until("/scan")
        rows = {line.split()[0]: line for line in s.text.split("\n") if line.startswith(" /")}
        assert "✖" in rows["/word"]
        assert "✖" in rows["/scan"] or "RELIABILITY" not in rows["/scan"]


@pytest.mark.parametrize(("key", "opens"), [("enter", "echo"), ("h", "hz"), ("p", "plot")])
async def test_keys(key: str, opens: str, graph: Graph) -> None:
    """Keys open the views of the topic."""
    await graph.start(Talker())
    async with stage(Content("topics"), graph=graph) as s:
        await s.until("/chatter")
        await s.press(key)
        assert s.view.content == Content(opens, "/chatter", s.view.options)
