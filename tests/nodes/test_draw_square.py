"""A turtle in a square."""

import pytest

from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from nodes.draw_square import DrawSquare
from nodes.turtlesim import TurtleSim
from tests.cases import slow


@slow
async def test_it_comes_back_to_where_it_began(graph: Graph) -> None:
    """Four sides of two metres, to the left, and then the same again."""
    await graph.start(TurtleSim(), DrawSquare())
    poses = graph.tap(Pose, "/turtle1/pose")

    await graph.clock.advance(40.0)

    for values in ([p.x for p in poses], [p.y for p in poses]):
        assert min(values) == pytest.approx(5.54, abs=0.02)
        assert max(values) == pytest.approx(7.54, abs=0.02)
    corners = [(round(p.x - 5.544), round(p.y - 5.544)) for p in poses if p.linear_velocity == p.angular_velocity == 0]
    visited = [corner for i, corner in enumerate(corners) if i == 0 or corner != corners[i - 1]]
    assert visited[:6] == [(0, 0), (2, 0), (2, 2), (0, 2), (0, 0), (2, 0)]
