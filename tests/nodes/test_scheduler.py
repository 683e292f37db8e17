"""Exercises 3 and 4: a follower with services of its own, and the scheduler that sends it from point to point."""

from __future__ import annotations

import logging
import math

import pytest

from graphflow import ParameterError, RemoteError
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtle_interfaces.srv import RandGoal, SetGoal
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from nodes.goal_follower import GoalFollower
from nodes.scheduler import Scheduler
from nodes.turtlesim import TurtleSim
from tests.cases import slow

POINTS = [(2, 1), (5, 9), (8, 1), (1, 6), (9, 6), (2, 1)]


@slow
async def test_all_points_are_visited_in_order(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The pose comes within the tolerance of each; then the turtle rests."""
    caplog.set_level(logging.INFO)
    poses = graph.tap(Pose, "/turtle1/pose", 100_000)
    await graph.start(TurtleSim(), GoalFollower(namespace="/turtle1", speed=2.0), Scheduler(namespace="/turtle1"))
    await graph.clock.advance(60.0)

    assert [m for m in caplog.messages if m.startswith("next")] == [f"next: ({x}, {y})" for x, y in POINTS]
    assert [m for m in caplog.messages if m.startswith("arrived")] == [f"arrived at ({x}, {y})" for x, y in POINTS]
    assert "all points visited" in caplog.messages
    for point in POINTS:
        assert min(math.dist((p.x, p.y), point) for p in poses) <= 0.1
    assert poses.latest.linear_velocity == 0.0


@slow
async def test_a_follower_without_a_goal_says_so(graph: Graph) -> None:
    """Enabled without a goal, it refuses; without a scheduler, it drives to its goal and only warns."""
    await graph.start(TurtleSim(), follower := GoalFollower(namespace="/turtle1"))
    with pytest.raises(RemoteError, match="set a goal first"):
        await graph.call(Empty, "/turtle1/enable", Empty.Request())
    await graph.call(SetGoal, "/turtle1/set_goal", SetGoal.Request(position={"x": 6.0, "y": 6.0}))
    await graph.call(Empty, "/turtle1/enable", Empty.Request())
    await graph.clock.advance(5.0)
    assert follower.pose is not None
    assert math.dist((follower.pose.x, follower.pose.y), (6, 6)) <= 0.1


async def test_random_goals_are_inside(graph: Graph) -> None:
    """Between 0.5 and 9.5 in both directions."""
    await graph.start(Scheduler(via_x=[], via_y=[]))
    for _ in range(20):
        at = (await graph.call(RandGoal, "/rand_goal", RandGoal.Request())).position
        assert 0.5 <= at.x <= 9.5
        assert 0.5 <= at.y <= 9.5


def test_lists_that_do_not_fit_are_refused() -> None:
    """There is no node then."""
    with pytest.raises(ParameterError, match="via_x has 1 numbers but via_y has 2"):
        Scheduler(via_x=[1.0], via_y=[1.0, 2.0])
