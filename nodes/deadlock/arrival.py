"""Exercise 4, a first attempt: a follower that reports its arrival, and a scheduler that responds with the next goal.

The scheduler's handler of `notify_arrival` sets the next goal and enables the follower *before* it responds. If the
follower clears `enabled` *after* its call, the effect depends on its groups: without groups there is a race (the
follower undoes its enabling, and the turtle stops at the second point), in one group a deadlock across two nodes. A
follower that clears `enabled` before the call, as `CarefulFollower` does, and lets the services run meanwhile, has
neither.
"""

from __future__ import annotations

import graphflow
from graphflow import Client, service
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtle_interfaces.srv import SetGoal

from ..position_controller import Point, PositionController


class Follower(PositionController):
    """Drive to the goal while enabled."""

    notify_arrival = Client(Empty, "notify_arrival")
    enabled = False
    next_goal: Point | None = None

    @service(SetGoal, "set_goal")
    async def set_goal(self, request: SetGoal.Request) -> SetGoal.Response:
        self.next_goal = Point(request.position.x, request.position.y)
        return SetGoal.Response()

    @service(Empty, "enable")
    async def enable(self, request: Empty.Request) -> Empty.Response:
        self.enabled = True
        if self.next_goal is not None:
            self.go_to(self.next_goal)
        return Empty.Response()

    async def arrived(self) -> None:
        if self.enabled:
            self.log.info("arrived at (%g, %g)", *self.goal or ())
            await self.notify_arrival.call(Empty.Request())
            self.enabled = False
            self.goal = None


class CarefulFollower(Follower):
    """Clear `enabled` before notifying the scheduler."""

    async def arrived(self) -> None:
        if self.enabled:
            self.log.info("arrived at (%g, %g)", *self.goal or ())
            self.enabled = False
            self.goal = None
            await self.notify_arrival.call(Empty.Request())


if __name__ == "__main__":
    graphflow.run(Follower)
