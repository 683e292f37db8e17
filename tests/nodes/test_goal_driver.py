"""Driving to places: the way, the arrival, obstacles, and goals of others. A whole tour is in tests/graphs."""

from __future__ import annotations

import math
from collections import deque

import pytest

from graphflow import Node, Time
from graphflow.msgs.geometry_msgs.msg import Point, PoseStamped, Quaternion, Twist
from graphflow.msgs.geometry_msgs.msg import Pose as PoseMessage
from graphflow.msgs.nav_msgs.msg import Path
from graphflow.msgs.std_msgs.msg import Header
from graphflow.qos import LATCHED
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms
from nodes.goal_driver import GoalDriver, Place


def test_velocities() -> None:
    """It turns on the spot, drives straight on, waits for an obstacle, turns to the heading, and has arrived."""
    driver = GoalDriver()
    driver.show = lambda: None  # type: ignore[method-assign]
    driver.ways = deque([Place(1.0, 0.0, math.pi / 2)])
    assert driver.towards(driver.ways[0], 0.0, 0.0, -1.5) == (0.0, 1.0)
    linear, angular = driver.towards(driver.ways[0], 0.0, 0.0, 0.1)
    assert linear == 0.2
    assert angular == pytest.approx(-0.25)
    driver.ahead = 0.1
    assert driver.towards(driver.ways[0], 0.0, 0.0, 0.1)[0] == 0.0
    assert driver.towards(driver.ways[0], 0.95, 0.0, 0.0) == (0.0, 1.0)
    assert driver.towards(driver.ways[0], 0.95, 0.0, 1.55) == (0.0, 0.0)
    assert not driver.ways


class Robot(Node):
    """Says where it is."""

    tf = Transforms(listen=False)

    def stand(self, x: float, y: float, yaw: float) -> None:
        self.tf.send(Transform.of("map", "base_footprint", (x, y, 0.0), rpy=(0.0, 0.0, yaw), stamp=Time(10**9)))
        self.tf.send_static(Transform.of("map", "odom", (1.0, 0.0, 0.0)))


async def test_a_goal_of_another(graph: Graph) -> None:
    """It replaces a tour, in whichever frame it is; the way that is left is published; on arrival the robot stops."""
    robot, driver = Robot(), GoalDriver(points=[5.0, 5.0, 6.0, 6.0], tour=True)
    await graph.start(robot, driver)
    plans, commands = graph.tap(Path, "/plan", LATCHED), graph.tap(Twist, "/cmd_vel")
    robot.stand(0.0, 0.0, 0.0)
    await graph.clock.advance(0.2)
    assert len(plans.latest.poses) == 2
    assert commands.latest.angular.z > 0
    goal = PoseMessage(position=Point(x=1.0), orientation=Quaternion(w=1.0))
    send = graph.publisher(PoseStamped, "/goal_pose")
    send.publish(PoseStamped(header=Header(frame_id="odom"), pose=goal))
    await graph.clock.advance(0.2)
    assert [(pose.pose.position.x, pose.pose.position.y) for pose in plans.latest.poses] == [(2.0, 0.0)]
    assert (commands.latest.linear.x, commands.latest.angular.z) == (0.2, 0.0)
    robot.stand(2.0, 0.05, 0.0)
    await graph.clock.advance(0.3)
    assert not plans.latest.poses
    assert (commands.latest.linear.x, commands.latest.angular.z) == (0.0, 0.0)


async def test_points_that_do_not_pair(graph: Graph) -> None:
    """The node does not start, and says why."""
    with pytest.raises(Exception, match="points has 3 numbers; give x and y of each place"):
        await graph.start(GoalDriver(points=[1.0, 2.0, 3.0]))


async def test_a_goal_that_is_no_place(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It is left out."""
    driver = GoalDriver()
    await graph.start(driver)
    graph.publisher(PoseStamped, "/goal_pose").publish(
        PoseStamped(pose=PoseMessage(position=Point(x=math.nan), orientation=Quaternion(w=1.0)))
    )
    await graph.settle()
    assert "a goal at nan, 0.0 is left out" in caplog.text
    assert not driver.ways
