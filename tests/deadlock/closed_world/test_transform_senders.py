"""Handlers that send transforms, by what the source of a class shows."""

from __future__ import annotations

import textwrap

import pytest

from graphflow.deadlock.closed_world import transform_senders
from graphflow.deadlock.closed_world.transform_senders import TransformSenders, publishing, senders, sending
from graphflow.machines.cache import GraphCache
from graphflow.machines.waits.wait_graph import ActivityView, QueueView, WaitGraph
from graphflow.wire.liveliness import Entity, Kind
from tests.deadlock.stage import Actor, Stage
from tests.written import Written

pytestmark = pytest.mark.usefixtures("graphflow_runner")
TEXT = """
class N:
    tf = None

{body}


{beside}
"""


def actor(written: Written, stage: Stage, body: str, beside: str = "") -> Actor:
    source = TEXT.replace("{body}", textwrap.indent(textwrap.dedent(body), "    ")).replace("{beside}", beside)
    node = written(source).N()
    found = stage.actor(node)
    found.transforms = {"tf"}
    for name in ("tick", "look"):
        if hasattr(node, name):
            stage.handler(found, name)
    return found


SENDS = "async def tick(self):\n    self.tell()\ndef tell(self):\n    self.tf.send(of('map', 'odom'))\n"


async def test_those_that_send(written: Written) -> None:
    """With the texts in their code and below it; texts of lookups do not count."""
    body = SENDS + "async def look(self):\n    await self.tf.lookup('a', 'b')\n"
    node = actor(written, Stage(), body)
    assert senders(node, {"tf"}) == {"tick": ("map", "odom")}
    both = (
        "async def tick(self):\n    await self.tf.lookup('map', 'base')\n    self.tf.send_static(of('map', 'odom'))\n"
    )
    assert senders(actor(written, Stage(), both), {"tf"}) == {"tick": ("map", "odom")}


@pytest.mark.parametrize(
    ("body", "beside"),
    [
        ("async def tick(self):\n    help(self.tf)\n", ""),
        ("async def tick(self):\n    later(self.tf.send)\n", ""),
        ("async def tick(self):\n    def f():\n        self.tf.send(1)\n    f()\n", ""),
        (SENDS, "def other(node):\n    node.tf.send(of('a', 'b'))\n"),
    ],
)
async def test_code_that_is_not_followed(written: Written, body: str, beside: str) -> None:
    """Then any handler may send anything."""
    assert senders(actor(written, Stage(), body, beside), {"tf"}) == {"tick": ()}


async def test_transforms_in_no_attribute(written: Written) -> None:
    """Nothing is known of them."""
    assert senders(actor(written, Stage(), SENDS), {"tf", ""}) == {"tick": ()}


async def test_texts_are_bounded(written: Written, monkeypatch: pytest.MonkeyPatch) -> None:
    """By number and length."""
    monkeypatch.setattr(transform_senders, "NAMES_BOUND", 2)
    body = f"async def tick(self):\n    self.tf.send('a', 'b', 'c', 'd', '{'x' * 200}', '\\x1b')\n"
    assert senders(actor(written, Stage(), body), {"tf"}) == {"tick": ("a", "b")}


def entity(node: str, kind: Kind = Kind.PUBLISHER) -> Entity:
    number = sum(node.encode())
    return Entity(0, "ab12", 1, number, kind, "/", node.removeprefix("/"), "/tf", transform_senders.TYPE, "x")


async def test_nodes_of_a_process(written: Written) -> None:
    """Hidden nodes are tools that only listen; one that publishes transforms by itself may send any."""
    stage = Stage()
    node = actor(written, stage, SENDS)
    found = TransformSenders(stage)
    assert found.texts(node, "tick") == ("map", "odom")
    assert found.texts(node, "look") is None
    node.full_name = "/_tool"
    assert TransformSenders(stage).texts(node, "tick") is None
    node.full_name, node.transforms = "/raw", set()
    assert TransformSenders(stage).texts(node, "tick") is None
    stage.cache.apply(entity("/raw").token, alive=True)
    assert TransformSenders(stage).texts(node, "tick") == ()


def test_graphs_of_other_executors() -> None:
    """All that belongs to a node that publishes transforms may send any."""
    cache = GraphCache()
    graph = WaitGraph({"a": ActivityView("a", "timer t", "/raw")}, queues={"q": QueueView("q", "timer t", "/no", ())})
    assert sending(graph, cache) is graph
    cache.apply(entity("/raw").token, alive=True)
    cache.apply(entity("/listens", Kind.SUBSCRIPTION).token, alive=True)
    assert publishing(cache) == {"/raw"}
    marked = sending(graph, cache)
    assert marked.activities["a"].sends == ()
    assert marked.queues["q"].sends is None
