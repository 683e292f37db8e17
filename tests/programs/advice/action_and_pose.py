"""A goal that drives until a pose is reached, which a handler of the same group takes in; behind a wall it never is."""

from __future__ import annotations

import math
from typing import Any

from graphflow import ActionClient, Group, Node, Param, Publisher, action, subscription, task, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import Float64
from graphflow.msgs.turtlesim.msg import Pose


class Driver(Node):
    default_group = Group(1)
    speed = Publisher(Float64, "speed")

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.pose = Pose()

    @subscription(Pose, "pose")
    async def on_pose(self, message: Pose) -> None:
        self.pose = message

    def distance(self, x: float) -> float:
        return math.hypot(x - self.pose.x, self.pose.y)

    @action(Fibonacci, "drive")
    async def drive(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        while self.distance(goal.request.order) > 0.1:
            self.speed.publish(Float64(data=1.0))
            await self.clock.sleep(0.05)  # stuck
        return Fibonacci.Result()


class World(Node):
    poses = Publisher(Pose, "pose")
    wall = 3.0
    x = 0.0

    @subscription(Float64, "speed")
    async def on_speed(self, message: Float64) -> None:
        self.x = min(self.wall, self.x + message.data)

    @timer(0.05)
    async def tell(self) -> None:
        self.poses.publish(Pose(x=self.x))


class Commander(Node):
    far = Param(3)
    drive = ActionClient(Fibonacci, "drive")

    @task
    async def command(self) -> None:
        async with self.drive.send(Fibonacci.Goal(order=self.far)) as goal:
            await goal.result()
            self.log.info("there")
