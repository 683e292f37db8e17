"""Records of frames, as a buffer gives them."""

from __future__ import annotations

from graphflow import Node, Time
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms


class Robot(Node):
    tf = Transforms()


async def test_a_frame_and_its_publisher(graph: Graph) -> None:
    """Rate, newest time, publisher, and how long nothing has come."""
    robot = Robot()
    await graph.start(robot)
    for second in (1, 2, 3):
        robot.tf.send(Transform.of("odom", "base", stamp=Time(second * 10**9)))
    await graph.settle()
    await graph.clock.advance(2.5)
    info = robot.tf.info("base")
    assert (info.parent, info.publisher, info.rate, info.newest) == ("odom", "/robot", 1.0, Time(3 * 10**9))
    assert info.silent == 2.5
