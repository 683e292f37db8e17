"""Exercise 4's race: the follower undoes the scheduler's enabling after its call."""

from __future__ import annotations

import logging

import pytest

from graphflow.interface import GroupChange
from graphflow.testing import Graph
from nodes.deadlock.arrival import CarefulFollower, Follower
from nodes.scheduler import Scheduler
from nodes.turtlesim import TurtleSim
from tests.cases import slow

TWO = {"motion": GroupChange(("control",)), "goals": GroupChange(("enable", "set_goal"))}


@slow
@pytest.mark.parametrize(
    ("follower", "groups", "points"),
    [(Follower, {}, 1), (Follower, TWO, 1), (CarefulFollower, {}, 6), (CarefulFollower, TWO, 6)],
)
async def test_only_care_ends_the_race(
    graph: Graph,
    caplog: pytest.LogCaptureFixture,
    follower: type[Follower],
    groups: dict[str, GroupChange],
    points: int,
) -> None:
    """Groups of their own bring the race back that one group prevented; clearing the flag before the call ends it."""
    caplog.set_level(logging.INFO)
    node = follower(namespace="/turtle1", speed=2.0, concurrency=groups)
    await graph.start(TurtleSim(), node, Scheduler(namespace="/turtle1"))
    await graph.clock.advance(60.0)

    assert sum(message.startswith("arrived at") for message in caplog.messages) == points
