"""A scheduler that sends a follower from point to point: two clients and two services in one node.

The follower calls `notify_arrival` on arrival, and the handler sets the next goal.
"""

from __future__ import annotations

import random
from typing import Any

import graphflow
from graphflow import Client, Node, Param, ParameterError, service, task
from graphflow.msgs.geometry_msgs.msg import Point
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtle_interfaces.srv import RandGoal, SetGoal


class Scheduler(Node):
    """Let a `GoalFollower` visit the points (via_x[0], via_y[0]), (via_x[1], via_y[1]), ..."""

    via_x = Param([2.0, 5.0, 8.0, 1.0, 9.0, 2.0], unit="m", doc="The points' x.", read_only=True)
    via_y = Param([1.0, 9.0, 1.0, 6.0, 6.0, 1.0], unit="m", doc="The points' y.", read_only=True)
    set_goal = Client(SetGoal, "set_goal")
    enable = Client(Empty, "enable")

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        if len(self.via_x) != len(self.via_y):
            raise ParameterError(
                f"via_x has {len(self.via_x)} numbers but via_y has {len(self.via_y)}: give the same number of each"
            )
        self.left = [Point(x=x, y=y) for x, y in zip(self.via_x, self.via_y, strict=True)]

    @task
    async def begin(self) -> None:
        await self.set_goal.wait_ready()
        await self.enable.wait_ready()
        await self.send_next()

    @service(Empty, "notify_arrival")
    async def arrived(self, request: Empty.Request) -> Empty.Response:
        await self.send_next()
        return Empty.Response()

    @service(RandGoal, "rand_goal")
    async def rand_goal(self, request: RandGoal.Request) -> RandGoal.Response:
        x, y = (9.0 * random.random() + 0.5 for _ in range(2))
        return RandGoal.Response(position=Point(x=x, y=y))

    async def send_next(self) -> None:
        if not self.left:
            self.log.info("all points visited")
            return
        goal = self.left.pop(0)
        self.log.info("next: (%g, %g)", goal.x, goal.y)
        await self.set_goal.call(SetGoal.Request(position=goal))
        await self.enable.call(Empty.Request())


if __name__ == "__main__":
    graphflow.run(Scheduler)
