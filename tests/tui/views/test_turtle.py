"""The turtles: found by their poses, drawn with their earlier trails, driven by keys."""

from __future__ import annotations

import math

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_a_turtle_draws(graph: Graph) -> None:
    """Earlier trails come as a picture, new ones by the poses."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("turtle"), graph=graph, size=(60, 30)) as s:
        await s.until(lambda: any("⠀" < c <= "⣿" for c in s.text), "the picture is drawn")
        await graph.settle()
        for i in range(20):
            node.pose.publish(Pose(x=2.0 + i / 10, y=9.0, theta=0.0))
            await graph.settle()
        await s.look()
        await s.until("▶")
        await s.until("x 3.9  y 9.0")
        before = sum("⠀" < c <= "⣿" for c in s.text)
        node.pose.publish(Pose(x=9.0, y=1.0, theta=math.pi / 2))
        await graph.settle()
        await s.look()
        await s.until("▲")
        assert abs(sum("⠀" < c <= "⣿" for c in s.text) - before) <= 2, "carried, not driven: no line"


@slow
@pytest.mark.parametrize(
    ("key", "linear", "angular"), [("up", 2.0, 0.0), ("down", -2.0, 0.0), ("left", 0.0, 2.0), ("right", 0.0, -2.0)]
)
async def test_arrows_drive(key: str, linear: float, angular: float, graph: Graph) -> None:
    """Arrow keys drive as turtlesim's own teleop does; the equivalent command is shown."""
    await graph.start(Talker(), Listener())
    driven = graph.tap(Twist, "/turtle1/cmd_vel")
    async with stage(Content("turtle"), graph=graph) as s:
        await s.until(lambda: s.view._driven == "turtle1")  # type: ignore[attr-defined]
        await graph.settle()
        await s.press(key)
        await s.until("$ graphflow topic pub --once /turtle1/cmd_vel geometry_msgs/msg/Twist")
        await graph.settle()
        assert (driven.latest.linear.x, driven.latest.angular.z) == (linear, angular)


@slow
async def test_without_a_turtle() -> None:
    """The view says what it waits for."""
    async with stage(Content("turtle")) as s:
        assert "waiting for a turtle" in s.text
