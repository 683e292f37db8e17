"""Curves of a topic's numbers."""

from __future__ import annotations

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import Range
from graphflow.msgs.std_msgs.msg import Bool, String
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views import plot
from graphflow.tui.views.plot import numbers
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def test_the_numbers_of_a_message() -> None:
    """By their paths, nested ones too; texts and arrays are none."""
    assert dict(numbers(Twist(linear=Vector3(x=1.5))))["linear.x"] == 1.5
    assert numbers(String(data="x")) == []
    assert numbers(Bool(data=True)) == [("data", 1.0)]
    assert "range" in dict(numbers(Range()))


async def test_fields_by_name_and_all(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """`topic.a,b` are two curves, a topic alone all its numbers; a field that is not there says so."""
    monkeypatch.setattr(plot, "SAMPLES_PER_SECOND", 1e9)
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", "/speed.linear.x,angular.q"), Content("plot", "/speed"), graph=graph) as s:
        await s.look()
        await graph.settle()
        for x in (0.0, 1.0, 2.0):
            node.speed.publish(Twist(linear=Vector3(x=x)))
            await graph.settle()
        await s.look()
        assert "━ linear.x 2" in s.text
        assert "━ angular.q no such number" in s.text
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
