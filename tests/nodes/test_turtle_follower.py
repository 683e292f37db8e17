"""A turtle that follows another."""

import math

from graphflow.msgs.turtlesim.msg import Pose
from graphflow.msgs.turtlesim.srv import Spawn, TeleportAbsolute
from graphflow.testing import Graph
from nodes.turtle_follower import TurtleFollower
from nodes.turtlesim import TurtleSim
from tests.cases import slow


def test_it_has_what_its_parent_has() -> None:
    """Parameters, topics and timers of both classes are in one interface."""
    interface = TurtleFollower.interface()

    assert interface.node_name == "turtle_follower"
    assert [p.name for p in interface.params] == ["gain", "speed", "tolerance"]
    assert {(e.kind, e.name) for e in interface.endpoints} == {
        ("publisher", "cmd_vel"),
        ("subscription", "pose"),
        ("subscription", "goal"),
    }
    assert {handler.name for handler in interface.handlers} == {"located", "control", "goal_moved"}


@slow
async def test_it_reaches_its_goal_and_follows_it(graph: Graph) -> None:
    """Wherever turtle1 is put, turtle2 ends within the tolerance of it."""
    await graph.start(TurtleSim())
    await graph.call(Spawn, "/spawn", Spawn.Request(x=2.0, y=2.0, name="turtle2"))
    await graph.start(TurtleFollower(namespace="/turtle2", remap=["goal:=/turtle1/pose"]))
    leader, follower = graph.tap(Pose, "/turtle1/pose"), graph.tap(Pose, "/turtle2/pose")

    for place in (TeleportAbsolute.Request(x=9.0, y=8.0), TeleportAbsolute.Request(x=1.0, y=9.0)):
        await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", place)
        await graph.clock.advance(15.0)

        assert math.dist((leader.latest.x, leader.latest.y), (follower.latest.x, follower.latest.y)) <= 0.1
        assert follower.latest.linear_velocity == 0.0
