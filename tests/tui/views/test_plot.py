"""Curves of a topic's numbers."""

from __future__ import annotations

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views import plot
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_fields_by_name_and_all(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """`topic.a,b` are two curves, a topic alone all its numbers."""
    monkeypatch.setattr(plot, "SAMPLES_PER_SECOND", 1e9)
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", "/speed.linear.x,angular.z"), Content("plot", "/speed"), graph=graph) as s:
        await s.look()
        await graph.settle()
        for x in (0.0, 1.0, 2.0):
            node.speed.publish(Twist(linear=Vector3(x=x)))
            await graph.settle()
        await s.look()
        assert "━ linear.x 2" in s.text
        assert "━ angular.z 0" in s.text
        assert any("\u2800" < letter <= "\u28ff" for letter in s.text), "no curve is drawn"
        await s.press("minus")
        await s.look()
        assert "60 s" in s.text
        await s.prefix("1")
        await s.look()
        await graph.settle()
        node.speed.publish(Twist(linear=Vector3(x=7.0)))
        await graph.settle()
        await s.look()
        assert "━ angular.z 0" in s.text


@pytest.mark.parametrize(
    ("about", "message"),
    [
        ("/speed.linear.q", "has no field 'q'"),
        ("/speed.linear", "no number"),
        ("/nothing", "nobody publishes /nothing"),
    ],
)
async def test_what_cannot_be_drawn(graph: Graph, about: str, message: str) -> None:
    """Is told in its place."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", about), graph=graph) as s:
        await s.look()
        await graph.settle()
        node.speed.publish(Twist())
        await graph.settle()
        await s.look()
        assert message in s.text
