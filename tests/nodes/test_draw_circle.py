"""A turtle in a circle."""

import pytest

from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from nodes.draw_circle import DrawCircle
from nodes.turtlesim import TurtleSim


async def test_the_circle_is_2_22_metres_across(graph: Graph) -> None:
    """2 m/s and 1.8 rad/s, for a little more than once round."""
    await graph.start(TurtleSim(), DrawCircle())
    poses = graph.tap(Pose, "/turtle1/pose")

    await graph.clock.advance(4.0)

    for values in ([p.x for p in poses], [p.y for p in poses]):
        assert max(values) - min(values) == pytest.approx(2.22, abs=0.01)


async def test_the_circle_follows_its_parameters(graph: Graph) -> None:
    """Half the speed makes half the circle, from the next command on."""
    circle = DrawCircle()
    await graph.start(TurtleSim(), circle)
    circle.linear = 1.0
    poses = graph.tap(Pose, "/turtle1/pose")

    await graph.clock.advance(4.0)

    assert max(p.x for p in poses) - min(p.x for p in poses) == pytest.approx(1.11, abs=0.01)
