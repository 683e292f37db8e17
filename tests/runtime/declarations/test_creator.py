"""Declarations of other packages, which make what they need on each node."""

from __future__ import annotations

from collections.abc import Sequence

from graphflow import Node
from graphflow.errors import Place
from graphflow.interface import EndpointInfo
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.declarations.creator import Maker
from graphflow.runtime.declarations.declare import Declaration
from graphflow.testing import Graph


class Twin(Declaration):
    """Two publishers, one of them remapped by the node's rules."""

    place = Place("twin.py", 1)

    def endpoints(self) -> Sequence[EndpointInfo]:
        return [EndpointInfo("publisher", name, "std_msgs/msg/String", self.attribute, self.place) for name in "ab"]

    def create(self, maker: Maker) -> object:
        return [maker.node.create_publisher(String, name) for name in "ab"], maker.owner.names.resolve("c")


class Twins(Node):
    pair = Twin()


async def test_a_declaration_of_a_new_kind(graph: Graph) -> None:
    """It is part of the interface, and its endpoints are the node's."""
    node = Twins(remap=["b:=left/b"])
    await graph.start(node)
    assert [(e.name, e.attribute) for e in Twins.interface().endpoints] == [("a", "pair"), ("b", "pair")]
    assert {"/a", "/left/b"} <= {e.name for e in node.endpoints}
    assert node._core.objects["pair"][1] == "/c"  # type: ignore[index]
