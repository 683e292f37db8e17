"""A turtle that drives to a frame."""

import math

import pytest

from graphflow import Node, timer
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms
from nodes.turtle_tf_listener import TurtleTfListener


class World(Node):
    """turtle2 stands at the origin; turtle1 drives along x at 1 m/s."""

    tf = Transforms(listen=False)
    x = 0.0

    @timer(0.1)
    async def step(self) -> None:
        self.x += 0.1
        self.tf.send(Transform.of("world", "turtle2"), Transform.of("world", "turtle1", (self.x, 3.0, 0.0)))


@pytest.mark.parametrize("delay", [0.0, 2.0])
async def test_it_drives_to_the_frame(graph: Graph, delay: float) -> None:
    """The command is that of ROS's tutorial, for the target now, or as it was some time ago."""
    await graph.start(World(), TurtleTfListener(delay=delay))
    commands = graph.tap(Twist, "/cmd_vel")
    await graph.clock.advance(5.0)
    x = 5.0 - delay
    assert commands.latest.linear.x == pytest.approx(0.5 * math.hypot(x, 3.0), abs=0.06)
    assert commands.latest.angular.z == pytest.approx(math.atan2(3.0, x), abs=0.03)


async def test_no_frame_is_there_yet(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It says what it waits for, and does not drive."""
    caplog.set_level("INFO")
    await graph.start(TurtleTfListener())
    commands = graph.tap(Twist, "/cmd_vel")
    await graph.clock.advance(2.0)
    assert list(commands) == []
    assert "turtle2 -> turtle1: there is no frame 'turtle2'; no frame is known so far; no node publishes" in caplog.text
