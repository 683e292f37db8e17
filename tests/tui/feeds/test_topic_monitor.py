"""Subscriptions for views, from the moment the topic exists."""

from __future__ import annotations

import pytest

from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_messages_and_their_arrival(graph: Graph) -> None:
    """Messages are counted, the latest is kept and passed to the callback; nothing comes after the end."""
    node = Talker()
    async with stage(Content("help"), graph=graph) as s:
        live = s.console.hub.live
        assert live is not None
        monitor = TopicMonitor(live, "/chatter")
        monitor.look()
        assert not monitor.is_open
        assert monitor.trouble == "nobody publishes /chatter yet"
        heard: list[str] = []
        monitor.on_message = lambda message, _: heard.append(message.data)
        await graph.start(node)
        monitor.look()
        await graph.settle()
        for word in ("a", "b"):
            node.chatter.publish(String(data=word))
        await graph.settle()
        assert (monitor.count, monitor.message.data, heard) == (2, "b", ["a", "b"])
        assert len(monitor.arrivals) == 2
        assert (monitor.lost, monitor.dropped) == (0, 0)
        monitor.close()
        node.chatter.publish(String(data="c"))
        await graph.settle()
        assert monitor.count == 2


async def test_a_misspelt_topic(graph: Graph) -> None:
    """The nearest name is suggested."""
    await graph.start(Talker())
    async with stage(Content("echo", "/chater"), graph=graph) as s:
        await s.until("nobody publishes /chater yet; did you mean /chatter?")


async def test_without_a_graph() -> None:
    """The monitor waits."""
    async with stage(Content("help")) as s:
        assert s.console.hub.live is not None
        monitor = TopicMonitor(s.console.hub.live, "/x")
        monitor.look()
        assert not monitor.is_open
