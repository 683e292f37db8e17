"""The messages of a topic: the latest, or as a stream; messages left out are counted."""

from __future__ import annotations

import pytest

from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import Stage, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def say(s: Stage, graph: Graph, node: Talker, *words: str) -> None:
    for word in words:
        node.chatter.publish(String(data=word))
    await graph.settle()
    await s.look()


@slow
async def test_the_latest_message(graph: Graph) -> None:
    """The latest message is updated in place; escape sequences in it have no effect."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("echo", "/chatter"), graph=graph) as s:
        await s.look()
        await graph.settle()
        await say(s, graph, node, "one", "two")
        assert "data: two" in s.text
        assert "data: one" not in s.text
        assert "2 messages" in s.text
        await say(s, graph, node, "\x1b[31mred")
        assert "\x1b" not in s.text
        assert "red" in s.text


@slow
async def test_one_after_the_other(graph: Graph) -> None:
    """Messages between two updates are counted."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("echo", "/chatter"), graph=graph) as s:
        await s.look()
        await s.press("s")
        await say(s, graph, node, "one")
        await say(s, graph, node, "two", "three", "four")
        assert "data: one" in s.text
        assert "data: four" in s.text
        assert "2 not shown" in s.text
        await s.press("space")
        await say(s, graph, node, "five")
        assert "five" not in s.text


async def test_a_topic_that_nobody_publishes(graph: Graph) -> None:
    """The view says that there is no publisher, and begins once there is one."""
    async with stage(Content("echo", "/chatter"), graph=graph) as s:
        await s.look()
        await s.until("nobody publishes /chatter yet")
        node = Talker()
        await graph.start(node)
        await s.look()
        await graph.settle()
        await say(s, graph, node, "one")
        assert "data: one" in s.text
