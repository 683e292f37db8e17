"""A turtle that drives to goals: services with a definition of your own, and a client in the same node.

`SetGoal` is defined in `interfaces/turtle_interfaces/srv/SetGoal.srv`; there is nothing to build. Another node sets
the goals, such as `scheduler.py`, whose service is called on arrival.
"""

from __future__ import annotations

import graphflow
from graphflow import CallError, Client, service
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtle_interfaces.srv import SetGoal

from .position_controller import Point, PositionController


class GoalFollower(PositionController):
    """Drive to the goal once enabled, and call `notify_arrival` on arrival."""

    notify_arrival = Client(Empty, "notify_arrival")
    next_goal: Point | None = None

    @service(SetGoal, "set_goal")
    async def set_goal(self, request: SetGoal.Request) -> SetGoal.Response:
        self.next_goal = Point(request.position.x, request.position.y)
        return SetGoal.Response()

    @service(Empty, "enable")
    async def enable(self, request: Empty.Request) -> Empty.Response:
        if self.next_goal is None:
            raise ValueError("set a goal first")
        self.go_to(self.next_goal)
        return Empty.Response()

    async def arrived(self) -> None:
        # Before the call, not after it: the scheduler may set the next goal while the call still waits.
        goal, self.goal = self.goal, None
        self.log.info("arrived at (%g, %g)", *goal or ())
        try:
            await self.notify_arrival.call(Empty.Request())
        except CallError as error:
            self.log.warning("could not notify of the arrival: %s", error)


if __name__ == "__main__":
    graphflow.run(GoalFollower)
