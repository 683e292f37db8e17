"""Decisions of the wall follower; whole runs are in tests/graphs/test_tb_graphs.py."""

from __future__ import annotations

import math

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.testing import Graph
from nodes.wall_follower import State, WallFollower


@pytest.mark.parametrize(
    ("before", "ahead", "beside", "state"),
    [
        (State.FIND, math.inf, math.inf, State.FIND),
        (State.FIND, math.inf, 0.5, State.FOLLOW),
        (State.FOLLOW, 0.3, 0.4, State.TURN),
        (State.TURN, 0.45, 0.4, State.TURN),  # with a margin, so that it does not waver
        (State.TURN, 0.6, 0.4, State.FOLLOW),
        (State.FOLLOW, math.inf, 1.5, State.FIND),
    ],
)
def test_states(before: State, ahead: float, beside: float, state: State) -> None:
    """A wall ahead makes it turn, a wall beside it follow."""
    node = WallFollower()
    node.state = before
    assert node.decide(ahead, beside) is state


@pytest.mark.parametrize(("right", "front", "sign"), [(0.4, 0.6, 0), (0.8, 1.1, -1), (0.25, 0.35, 1)])
async def test_steering(graph: Graph, right: float, front: float, sign: int) -> None:
    """Too far from the wall it steers to the right, too near to the left; while turning it stands."""
    node = WallFollower()
    await graph.start(node)
    driven = graph.tap(Twist, "/cmd_vel")
    node.state = State.FOLLOW
    node.drive(right, front)
    await graph.settle()
    assert driven.latest.linear.x > 0.05
    assert round(driven.latest.angular.z, 0) * sign >= 0
    assert abs(driven.latest.angular.z) > 0.1 if sign else abs(driven.latest.angular.z) < 0.1
    node.state = State.TURN
    node.drive(right, front)
    await graph.settle()
    assert (driven.latest.linear.x, driven.latest.angular.z) == (0.0, 0.8)
