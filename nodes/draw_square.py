"""A turtle in a square: a plan whose steps each run until the turtle has reached the target pose."""

import math
from collections.abc import Callable

import graphflow
from graphflow import Client, Node, Param, Publisher, Subscription, task
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtlesim.msg import Pose

NEAR = 0.001
"""Tolerance in metres or radians."""


class DrawSquare(Node):
    """Drive turtle1 along a square, again and again."""

    side = Param(2.0, gt=0.0, unit="m", doc="Length of a side.")
    cmd_vel = Publisher(Twist, "turtle1/cmd_vel")
    pose = Subscription(Pose, "turtle1/pose")
    reset = Client(Empty, "reset")

    @task
    async def draw(self) -> None:
        await self.reset.call(Empty.Request())
        while True:
            await self.move(self.way_left, lambda speed: Twist(linear=Vector3(x=speed)))
            await self.move(turn_left, lambda speed: Twist(angular=Vector3(z=speed)))

    async def move(self, left: Callable[[Pose, Pose], float], command: Callable[[float], Twist]) -> None:
        """Send commands until nothing is left, decelerating towards the end."""
        start: Pose | None = None
        async for pose in self.pose:
            start = start or pose
            if (rest := left(start, pose)) < NEAR:
                break
            self.cmd_vel.publish(command(min(1.0, 5.0 * rest)))
        self.cmd_vel.publish(Twist())

    def way_left(self, start: Pose, pose: Pose) -> float:
        return self.side - math.hypot(pose.x - start.x, pose.y - start.y)


def turn_left(start: Pose, pose: Pose) -> float:
    """Return the radians left of a quarter turn."""
    return math.pi / 2 - (pose.theta - start.theta + 0.1) % (2 * math.pi) + 0.1


if __name__ == "__main__":
    graphflow.run(DrawSquare)
