"""The elements of a graph's picture, and their Mermaid and Graphviz sources."""

from __future__ import annotations

from graphflow import Node, Publisher, Subscription
from graphflow.introspect.drawing.picture import Arrow, Picture, box_of, dot, mermaid, misfit, picture
from graphflow.machines.cache import GraphCache
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.testing import Graph
from tests.tui.nodes import Listener, Talker


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


MADE = Picture(("/a", "/b"), ("/t",), (Arrow("/a", "/t"), Arrow("/t", "/b", True)))


def test_mermaid() -> None:
    """A flow chart; what does not fit is red."""
    assert mermaid(MADE).splitlines() == [
        "flowchart LR",
        '  n0(["/a"])',
        '  n1(["/b"])',
        '  n2["/t"]',
        "  n0 --> n2",
        "  n2 --> n1",
        "  linkStyle 1 stroke:red",
    ]
    assert "linkStyle" not in mermaid(Picture(("/a",), ("/t",), (Arrow("/a", "/t"),)))


def test_graphviz() -> None:
    """A digraph; what does not fit is red."""
    lines = dot(MADE).splitlines()
    assert (lines[0], lines[-1]) == ("digraph graphflow {", "}")
    assert '  "/a" [shape=ellipse];' in lines
    assert '  "/a" -> "/t";' in lines
    assert '  "/t" -> "/b" [color=red];' in lines


async def test_what_keeps_them_apart(graph: Graph) -> None:
    """Incompatible policies, or the type, are named."""
    cache = await cache_of(graph, Talker(), Listener())
    assert misfit(cache.named("/chatter")) == ""
    await graph.start(Wrong())
    assert misfit(cache.named("/chatter")) == "type"
