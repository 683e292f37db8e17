"""A robot that drives to places in a frame: those of `goal_pose`, as rviz's tool sends them, or a list of its own.

It plans nothing: it turns towards the place and drives straight on, and waits while something is in its way.
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import graphflow
from graphflow import Node, Param, Publisher, TransformError, subscription, timer
from graphflow.msgs.geometry_msgs.msg import Point, PoseStamped, Quaternion, Twist, Vector3
from graphflow.msgs.geometry_msgs.msg import Pose as PoseMessage
from graphflow.msgs.nav_msgs.msg import Path
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import Header
from graphflow.qos import LATCHED, SENSOR_DATA
from graphflow.tf import Transforms

from .reactive_control import nearest


class Place(NamedTuple):
    """x and y in metres; a heading in radians, or None for any."""

    x: float
    y: float
    yaw: float | None = None


class GoalDriver(Node):
    """Drive to places one after another."""

    points = Param([0.0, 0.0], read_only=True, doc="The places of a tour, in metres: x and y of each in turn.")
    tour = Param(False, read_only=True, doc="Whether to drive through `points` first.")
    frame = Param("map", read_only=True, doc="The frame of the places.")
    base_frame = Param("base_footprint", read_only=True, doc="The frame of the robot.")
    speed = Param(0.2, unit="m/s", gt=0.0, le=1.0, doc="On a free way.")
    turn_speed = Param(1.0, unit="rad/s", gt=0.0, le=3.0, doc="At most.")
    near = Param(0.12, unit="m", gt=0.0, doc="How near a place counts as reached.")
    safe = Param(0.22, unit="m", gt=0.0, doc="How near something ahead may come before the robot waits.")
    tf = Transforms()
    cmd_vel = Publisher(Twist, "cmd_vel")
    plan = Publisher(Path, "plan", LATCHED)
    ahead = math.inf

    async def on_start(self) -> None:
        numbers = list(self.points)
        if len(numbers) % 2:
            raise ValueError(f"points has {len(numbers)} numbers; give x and y of each place")
        places = zip(numbers[::2], numbers[1::2], strict=True) if self.tour else []
        self.ways = deque(Place(x, y) for x, y in places)
        self.is_driving = False
        self.show()

    @subscription(LaserScan, "scan", SENSOR_DATA)
    async def scanned(self, scan: LaserScan) -> None:
        self.ahead = nearest(scan, 0.0, math.radians(40))

    @subscription(PoseStamped, "goal_pose")
    async def take(self, goal: PoseStamped) -> None:
        """Take a new goal in the place of all others."""
        if goal.header.frame_id not in ("", self.frame):
            goal = await self.tf.transform(goal, to=self.frame, timeout=1.0)
        at, turn = goal.pose.position, goal.pose.orientation
        yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
        if not math.isfinite(at.x + at.y + yaw):
            self.log.warning("a goal at %s, %s is left out", at.x, at.y)
            return
        self.log.info("drives to (%.2f, %.2f)", at.x, at.y)
        self.ways = deque([Place(at.x, at.y, yaw)])
        self.show()

    def show(self) -> None:
        """Publish the places that are left."""
        header = Header(frame_id=self.frame, stamp=self.clock.now())
        poses = []
        for x, y, yaw in self.ways:
            turn = Quaternion(z=math.sin((yaw or 0.0) / 2), w=math.cos((yaw or 0.0) / 2))
            poses.append(PoseStamped(header=header, pose=PoseMessage(position=Point(x=x, y=y), orientation=turn)))
        self.plan.publish(Path(header=header, poses=poses))

    async def on_shutdown(self) -> None:
        self.cmd_vel.publish(Twist())  # else a real robot drives on

    @timer(hz=10.0)
    async def drive(self) -> None:
        if not self.ways:
            if self.is_driving:
                self.is_driving = False
                self.cmd_vel.publish(Twist())
                self.log.info("has arrived")
            return
        self.is_driving = True
        try:
            at = self.tf.get(self.frame, self.base_frame)
        except TransformError as error:
            self.log.info("waits for its place: %s", error, throttle=5.0)
            return
        linear, angular = self.towards(self.ways[0], at.translation[0], at.translation[1], at.yaw)
        self.cmd_vel.publish(Twist(linear=Vector3(x=linear), angular=Vector3(z=angular)))

    def towards(self, place: Place, x: float, y: float, yaw: float) -> tuple[float, float]:
        """Return the velocities in m/s and rad/s that lead to a place; a place that is reached is taken away."""
        if math.hypot(place.x - x, place.y - y) > self.near:
            wrong = math.remainder(math.atan2(place.y - y, place.x - x) - yaw, math.tau)
            is_free = self.ahead > self.safe
            if not is_free:
                self.log.info("waits: something is %.2f m ahead", self.ahead, throttle=5.0)
            linear = self.speed if abs(wrong) < 0.4 and is_free else 0.0
        else:
            wrong = 0.0 if place.yaw is None else math.remainder(place.yaw - yaw, math.tau)
            linear = 0.0
            if abs(wrong) < 0.1:
                self.ways.popleft()
                self.show()
                return 0.0, 0.0
        return linear, max(-self.turn_speed, min(self.turn_speed, 2.5 * wrong))


if __name__ == "__main__":
    graphflow.run(GoalDriver)
