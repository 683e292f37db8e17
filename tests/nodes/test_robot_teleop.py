"""A robot driven with keys."""

from __future__ import annotations

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, TwistStamped
from graphflow.testing import Graph
from nodes.robot_teleop import RobotTeleop


class Silent(RobotTeleop):
    """Without a terminal."""

    async def read_keys(self) -> None:
        """Read nothing."""


@pytest.mark.parametrize("stamped", [False, True])
async def test_keys(graph: Graph, stamped: bool) -> None:
    """Each changes a speed by a step, within the robot's limits; the speeds are sent again and again."""
    node = Silent(stamped=stamped)
    await graph.start(node)
    sent = graph.tap(TwistStamped, "/cmd_vel") if stamped else graph.tap(Twist, "/cmd_vel")
    for key in ("w", "w", "up", "a", "d", "right", "?"):
        node.press(key)
    await graph.clock.advance(0.5)
    twist = sent.latest.twist if isinstance(sent.latest, TwistStamped) else sent.latest
    assert (twist.linear.x, twist.angular.z) == pytest.approx((0.03, -0.1))
    assert len(sent) == 5
    for _ in range(100):
        node.press("w")
    assert node.linear == 0.22
    node.press("s")
    assert (node.linear, node.angular) == (0.0, 0.0)


async def test_without_a_terminal(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The error says where to run it."""
    node = RobotTeleop()
    with pytest.raises(Exception, match="run teleop_keyboard in its own terminal"):
        await graph.start(node)
        await graph.clock.advance(0.1)
        await node.wait_ended()


async def test_the_end(graph: Graph) -> None:
    """The last message stops the robot, also at Ctrl-C."""
    node = Silent()
    sent = graph.tap(Twist, "/cmd_vel")
    await graph.start(node)
    node.press("w")
    await graph.clock.advance(0.1)
    assert sent.latest.linear.x == 0.01
    await graph.stop(node)
    assert sent.latest.linear.x == 0.0
