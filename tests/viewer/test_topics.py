"""Topics in a viewer."""

from __future__ import annotations

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from tests.viewer.cast import Robot, served, viewer

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_messages(graph: Graph) -> None:
    """Come as they are, with the time of their sending, and only while somebody looks."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen, viewer(lab.port) as other:
        twist = Twist(linear=Vector3(x=0.5))
        await seen.subscribe(7, "/speed")
        await seen.until(lambda: robot.speed.get_subscription_count() == 1)
        robot.speed.publish(twist)
        await seen.until(lambda: seen.messages)
        assert seen.messages[0].payload == twist.to_bytes()
        assert (seen.messages[0].subscription, seen.messages[0].log_ns) == (7, graph.clock.time_ns())
        await other.subscribe(1, "/speed")
        await seen.send("unsubscribe", subscriptionIds=[7])
        await other.send("unsubscribe", subscriptionIds=[1])
        await seen.until(lambda: robot.speed.get_subscription_count() == 0)


async def test_a_latched_topic(graph: Graph) -> None:
    """Is shown to each who comes later."""
    robot = Robot()
    async with served(graph, robot) as lab:
        robot.map.publish(String(data="a map"))
        for _ in range(2):
            async with viewer(lab.port) as first, viewer(lab.port) as second:
                await first.subscribe(1, "/map")
                await first.until(lambda seen=first: seen.messages)  # type: ignore[misc]
                await second.subscribe(1, "/map")
                await second.until(lambda seen=second: seen.messages)  # type: ignore[misc]
