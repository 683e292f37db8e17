"""Nodes with their links, and the nodes at the other end."""

from __future__ import annotations

import pytest

from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.nodes.tree import Tree
from tests.cases import slow
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def lines(text: str) -> list[str]:
    """The rows of the table, reduced to the first two columns."""
    return [" ".join(line.split()) for line in text.split("\n")[2:] if "/" in line]


async def test_a_node(graph: Graph) -> None:
    """A node's links are below it: an action is one link, and those of every node are left out."""
    await graph.start(Talker(), Listener())
    async with stage(Content("tree", "/talker"), graph=graph, size=(110, 30)) as s:
        await s.until("has the action, no clients")
        assert lines(s.text)[:7] == [
            "▾ /talker 6 links",
            "▾ /chatter publishes, 1 subscription std_msgs/msg/String",
            "/listener subscribes",
            "/speed publishes, no subscriptions geometry_msgs/msg/Twist",
            "/turtle1/pose publishes, no subscriptions turtlesim/msg/Pose",
            "/add serves, no clients example_interfaces/srv/AddTwoInts",
            "/fibonacci has the action, no clients example_interfaces/action/Fibonacci",
        ]
        assert "parameter" not in s.text
        await s.press("down", "down", "y")
        assert s.console.clipboard_text == "/listener"
        await s.press("space")
        await s.until("▸ /chatter")
        assert "/listener subscribes" not in lines(s.text)
        await s.press("space", "down", "enter")
        await s.until("tree /listener")
        await s.until("▾ /chatter")
        assert "/talker" in s.text


@slow
async def test_all_nodes(graph: Graph) -> None:
    """All nodes are folded at first; unfolded rows are saved with the windows."""
    await graph.start(Talker(), Listener())
    async with stage(Content("tree"), graph=graph, size=(110, 30)) as s:
        await s.until("▸ /listener")
        assert "▸ /talker 6 links" in lines(s.text)
        assert "▸ /listener 2 links" in lines(s.text)
        assert isinstance(s.view, Tree)
        s.view.choose("/talker")
        await s.press("enter")
        await s.until("▸ /chatter")
        await s.press("down", "space")
        await s.until(lambda: "/listener subscribes" in lines(s.text))
        assert s.view.content.options["turned"] == ["/talker", "/talker\nMP\n/chatter"]
        await s.press("down", "space")
        await s.until("▸ /chatter")
        await s.press("enter")
        await s.until("echo /chatter")


@slow
@pytest.mark.parametrize(("name", "opened"), [("/add", "call /add"), ("/fibonacci", "goals")])
async def test_what_is_opened(graph: Graph, name: str, opened: str) -> None:
    """Enter opens a service's form or an action's goals."""
    await graph.start(Talker())
    async with stage(Content("tree", "/talker"), graph=graph, size=(110, 30)) as s:
        await s.until(name)
        assert isinstance(s.view, Tree)
        s.view.choose(f"/talker\nSS\n{name}")
        await s.press("enter")
        await s.until(opened)


@slow
async def test_from_the_list_of_nodes(graph: Graph) -> None:
    """x opens the tree."""
    await graph.start(Talker())
    async with stage(Content("nodes"), graph=graph, size=(110, 30)) as s:
        await s.until("/talker")
        await s.press("x")
        await s.until("tree /talker")
