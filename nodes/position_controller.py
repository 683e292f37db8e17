"""A controller that drives a turtle to a point: a base class for nodes.

A node class inherits the parameters, topics and timers of its parent. This one lacks only a goal, which its subclasses
get from a topic (`turtle_follower.py`) or a list (`via_point_follower.py`). They may override `arrived` and `departed`.

The names are relative. Put the node in a turtle's namespace and `pose` is that turtle's:

    python -m nodes.turtle_follower --ros-args -r __ns:=/turtle2 -r goal:=/turtle1/pose
"""

from __future__ import annotations

import math
from typing import NamedTuple

from graphflow import Node, Param, Publisher, subscription, timer
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.turtlesim.msg import Pose


class Point(NamedTuple):
    """A position in metres."""

    x: float
    y: float


def distance(pose: Pose, goal: Point) -> float:
    """Return the distance in metres from a pose to a goal."""
    return math.hypot(goal.x - pose.x, goal.y - pose.y)


def steer(pose: Pose, goal: Point, *, gain: float, speed: float) -> Twist:
    """Return the velocity towards the goal: the larger the angle to it, the faster the turn and the slower the drive.

    At constant full speed a turtle that has just missed its goal would circle around it for ever.
    """
    error = math.atan2(goal.y - pose.y, goal.x - pose.x) - pose.theta
    shortest = math.atan2(math.sin(error), math.cos(error))  # in -pi..pi, the shorter way round
    return Twist(linear=Vector3(x=speed * max(0.0, math.cos(shortest))), angular=Vector3(z=gain * shortest))


class PositionController(Node):
    """Drive to `goal`, wait there, and follow it when it moves."""

    gain = Param(5.0, unit="1/s", gt=0.0, doc="Turning speed for each radian off course.")
    speed = Param(1.0, unit="m/s", ge=0.0, doc="Forward speed on the way.")
    tolerance = Param(0.1, unit="m", gt=0.0, doc="How close counts as there.")
    cmd_vel = Publisher(Twist, "cmd_vel")

    pose: Pose | None = None
    goal: Point | None = None
    is_there = False

    def go_to(self, goal: Point) -> None:
        """Set another goal. Reaching it calls `arrived`, even if the turtle is already there."""
        self.goal, self.is_there = goal, False

    @subscription(Pose, "pose")
    async def located(self, pose: Pose) -> None:
        self.pose = pose

    @timer(0.1)
    async def control(self) -> None:
        if self.pose is None or self.goal is None:
            return
        was_there, self.is_there = self.is_there, distance(self.pose, self.goal) <= self.tolerance
        if self.is_there:
            self.cmd_vel.publish(Twist())
        else:
            self.cmd_vel.publish(steer(self.pose, self.goal, gain=self.gain, speed=self.speed))
        if self.is_there and not was_there:
            await self.arrived()
        elif was_there and not self.is_there:
            await self.departed()

    async def arrived(self) -> None:
        """React to reaching the goal; for subclasses."""

    async def departed(self) -> None:
        """React to leaving the goal, because the goal or the turtle was moved; for subclasses."""
