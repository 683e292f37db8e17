"""A first go-to-goal: the goal's handler polls a pose that no handler can update meanwhile.

`BlockingDriver` sleeps in a `def`, `AsyncDriver` in an `async def`. Which handlers are blocked depends on the groups
that the graph file assigns.
"""

from __future__ import annotations

import math
import time

import graphflow
from graphflow import ActionClient, Node, Publisher, action, subscription, task
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.turtle_interfaces.action import GoToGoal
from graphflow.msgs.turtlesim.msg import Pose

GOAL = (8.0, 5.544445)


class Driver(Node):
    """Drive straight ahead until the goal is near, and send itself there at the start."""

    node_name = "driver"
    cmd_vel = Publisher(Twist, "cmd_vel")
    goals = ActionClient(GoToGoal, "go_to_goal")
    x = y = 0.0

    @subscription(Pose, "pose", 1)
    def located(self, pose: Pose) -> None:
        self.x, self.y = pose.x, pose.y

    def distance(self) -> float:
        return math.hypot(GOAL[0] - self.x, GOAL[1] - self.y)

    def drive(self, speed: float) -> None:
        self.cmd_vel.publish(Twist(linear=Vector3(x=speed)))

    @task
    async def ask(self) -> None:
        async with self.goals.send(GoToGoal.Goal(position={"x": GOAL[0], "y": GOAL[1]})) as goal:
            await goal.result()
            self.log.info("there")


class BlockingDriver(Driver):
    """Sleep without releasing the loop or the group."""

    @action(GoToGoal, "go_to_goal")
    def execute(self, goal: GoToGoal.Handle) -> GoToGoal.Result:
        while self.distance() > 0.1:
            self.drive(1.0)
            time.sleep(0.05)
        self.drive(0.0)
        return GoToGoal.Result()


class AsyncDriver(Driver):
    """Sleep without releasing the group; the loop is free."""

    @action(GoToGoal, "go_to_goal")
    async def execute(self, goal: GoToGoal.Handle) -> GoToGoal.Result:
        while self.distance() > 0.1:
            self.drive(1.0)
            await self.clock.sleep(0.05)
        self.drive(0.0)
        return GoToGoal.Result()


if __name__ == "__main__":
    graphflow.run(AsyncDriver)
