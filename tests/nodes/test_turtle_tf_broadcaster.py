"""A turtle's pose as a transform."""

import pytest

from graphflow import Node
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from graphflow.tf import Transforms
from nodes.turtle_tf_broadcaster import TurtleTfBroadcaster


class Listener(Node):
    tf = Transforms()


async def test_the_frame_is_where_the_turtle_is(graph: Graph) -> None:
    """In `world`, turned as the turtle is."""
    listener = Listener()
    await graph.start(listener, TurtleTfBroadcaster(turtlename="turtle7"))
    graph.publisher(Pose, "/pose").publish(Pose(x=3.0, y=4.0, theta=0.5))
    await graph.settle()
    found = listener.tf.get("world", "turtle7")
    assert found.translation == pytest.approx((3.0, 4.0, 0.0))
    assert found.yaw == pytest.approx(0.5)
