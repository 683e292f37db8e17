"""The graph as boxes: what is in the picture, and what the keys do with it."""

from __future__ import annotations

import pytest

from graphflow import Node, Publisher, Subscription
from graphflow.machines.cache import GraphCache
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.graph import Arrow, Picture, box_of, picture
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Wrong(Node):
    """Listens to another type."""

    node_name = "wrong"
    chatter = Subscription(Int32, "chatter")


class Inner(Node):
    """Talks to itself."""

    node_name = "inner"
    to = Publisher(String, "loop")
    back = Subscription(String, "loop")


async def cache_of(graph: Graph, *nodes: Node) -> GraphCache:
    await graph.start(*nodes)
    return nodes[0].context.cache


async def test_what_is_drawn(graph: Graph) -> None:
    """Nodes, the topics between them, red where they do not fit; not what every node has."""
    cache = await cache_of(graph, Talker(), Listener(), Wrong())
    found = picture(cache, "", frozenset(), everything=False)
    assert found == Picture(
        ("/listener", "/talker", "/wrong"),
        ("/chatter",),
        (
            Arrow("/talker", "/chatter", True),
            Arrow("/chatter", "/listener", True),
            Arrow("/chatter", "/wrong", True),
        ),
    )
    assert "/rosout" in picture(cache, "", frozenset(), everything=True).topics
    assert "/speed" in picture(cache, "", frozenset(), everything=True).topics


async def test_collapsing(graph: Graph) -> None:
    """Nodes of one namespace as one box; what stays within it is not drawn."""
    cache = await cache_of(
        graph, Talker(namespace="/arm/left"), Listener(namespace="/arm/left"), Inner(namespace="/leg")
    )
    found = picture(cache, "", frozenset({"/arm"}), everything=False)
    assert found.nodes == ("/arm/…", "/leg/inner")
    assert found.topics == ()
    assert box_of("/armada/x", {"/arm"}) == "/armada/x"
    assert picture(cache, "/leg", frozenset(), everything=True).nodes[0] == "/leg/inner"


async def test_the_drawing_and_its_keys(graph: Graph) -> None:
    """Boxes with names; n chooses one, enter opens it, M copies the drawing."""
    await graph.start(Talker(), Listener())
    async with stage(Content("graph"), graph=graph, size=(120, 30)) as s:
        await s.until("/chatter")
        assert "╭" in s.text
        assert "▶" in s.text
        await s.press("n")
        assert s.view.chosen() == {"node": "/listener"} or s.view.chosen() == {}
        await s.press("n", "n")
        assert s.view.chosen() == {"topic": "/chatter"}
        await s.press("M")
        assert s.console.clipboard_text.startswith("flowchart LR\n")
        assert s.console.clipboard_text.count("-->") == 2
        await s.press("enter")
        assert str(s.view.content) == "echo /chatter"


async def test_what_is_wider_than_the_pane(graph: Graph) -> None:
    """It says so, and scrolls sideways."""
    await graph.start(Talker(), Listener())
    async with stage(Content("graph"), graph=graph, size=(34, 30)) as s:
        await s.until("←→ more")
        assert "/listener" not in s.text
        await s.press("right", "right")
        await s.until("/listener")
        await s.press("left", "left")
        await s.until("/talker")
