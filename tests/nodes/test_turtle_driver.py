"""Exercise 5: the drive to a goal as an action."""

from __future__ import annotations

import asyncio
import math
from itertools import pairwise
from typing import Any

import pytest

from graphflow import GoalRejected, GoalStatus
from graphflow.msgs.turtle_interfaces.action import GoToGoal
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.testing import Graph
from nodes.turtle_driver import TurtleDriver
from nodes.turtlesim import TurtleSim

START = 11.088889122009277 / 2


async def drive(graph: Graph, x: float, y: float) -> ClientGoalHandle[Any, Any, Any]:
    client = graph.action_client(GoToGoal, "/turtle1/go_to_goal")
    await graph.settle()
    return await client.send_goal(GoToGoal.Goal(position={"x": x, "y": y}))


async def test_the_result_is_the_distance_travelled(graph: Graph) -> None:
    """Within 5 % of the path, with the elapsed time five times a second or more on the way."""
    poses = graph.tap(Pose, "/turtle1/pose", 10_000)
    await graph.start(TurtleSim(), TurtleDriver(namespace="/turtle1"))
    goal = await drive(graph, 9.0, 5.5)
    heard: list[float] = []

    async def listen() -> None:
        async for feedback in goal.feedback():
            heard.append(feedback.elapsed)

    listening = asyncio.ensure_future(listen())
    await graph.clock.advance(6.0)
    await listening

    path = sum(math.dist((a.x, a.y), (b.x, b.y)) for a, b in pairwise(poses))
    assert (await goal.result()).distance == pytest.approx(path, rel=0.05)
    assert path == pytest.approx(9.0 - START - 0.1, rel=0.1)
    assert len(heard) / heard[-1] >= 5
    assert poses.latest.linear_velocity == 0.0


async def test_a_drive_can_be_called_off(graph: Graph) -> None:
    """The turtle stops where it is, and its client learns how far it came."""
    poses = graph.tap(Pose, "/turtle1/pose", 10_000)
    await graph.start(TurtleSim(), TurtleDriver(namespace="/turtle1"))
    goal = await drive(graph, 9.0, 5.5)
    await graph.clock.advance(1.5)
    assert await goal.cancel()
    await graph.clock.advance(1.0)

    assert goal.status is GoalStatus.CANCELED
    assert poses.latest.linear_velocity == 0.0
    assert START + 1.0 < poses.latest.x < START + 1.6


async def test_a_newer_goal_takes_the_place_of_an_older(graph: Graph) -> None:
    """The older is aborted."""
    await graph.start(TurtleSim(), TurtleDriver(namespace="/turtle1"))
    older = await drive(graph, 9.0, 9.0)
    await graph.clock.advance(0.5)
    newer = await drive(graph, 5.0, 5.0)
    await graph.clock.advance(8.0)

    assert (older.status, newer.status) == (GoalStatus.ABORTED, GoalStatus.SUCCEEDED)


async def test_a_goal_outside_of_the_world_is_rejected(graph: Graph) -> None:
    """No turtle gets there."""
    await graph.start(TurtleSim(), TurtleDriver(namespace="/turtle1"))
    with pytest.raises(GoalRejected):
        await drive(graph, 12.0, 5.0)
