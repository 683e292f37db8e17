"""The keys of teleop_twist_keyboard."""

from __future__ import annotations

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, TwistStamped
from graphflow.testing import Graph
from nodes.twist_teleop import TwistTeleop


class Silent(TwistTeleop):
    """Without a terminal."""

    async def read_keys(self) -> None:
        """Read nothing."""


@pytest.mark.parametrize(
    ("keys", "linear", "angular"),
    [("i", 0.5, 0.0), ("o", 0.5, -1.0), ("m", -0.5, -1.0), ("i?", 0.0, 0.0), ("qi", 0.55, 0.0), ("cj", 0.0, 0.9)],
)
async def test_keys(graph: Graph, keys: str, linear: float, angular: float) -> None:
    """A key drives, changes the speeds, or stops."""
    node = Silent()
    heard = graph.tap(Twist, "/cmd_vel")

    await graph.start(node)
    for key in keys:
        node.press(key)
    await graph.settle()
    assert (heard.latest.linear.x, heard.latest.angular.z) == pytest.approx((linear, angular))


async def test_stamped(graph: Graph) -> None:
    """With the parameter `stamped`, the messages have a header."""
    node = Silent(stamped=True, frame_id="base")
    heard = graph.tap(TwistStamped, "/cmd_vel")
    await graph.start(node)
    node.press("up")
    await graph.settle()
    assert (heard.latest.twist.linear.x, heard.latest.header.frame_id) == (0.5, "base")


async def test_the_end(graph: Graph) -> None:
    """The last message stops the robot, also at Ctrl-C."""
    node = Silent()
    heard = graph.tap(Twist, "/cmd_vel")
    await graph.start(node)
    node.press("i")
    await graph.stop(node)
    assert [twist.linear.x for twist in heard] == [0.5, 0.0]
