"""A turtle that an action drives to a position, with feedback and cancellation.

The goal's handler waits while the timer of `PositionController` drives. `GoToGoal` is defined in
`interfaces/turtle_interfaces/action/GoToGoal.action`.

    graphflow action send_goal /turtle1/go_to_goal turtle_interfaces/action/GoToGoal "{position: {x: 9, y: 9}}" -f
"""

from __future__ import annotations

import graphflow
from graphflow import action
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.turtle_interfaces.action import GoToGoal
from graphflow.msgs.turtlesim.msg import Pose

from .position_controller import Point, PositionController, distance

SIDE = 11.0
"""Width and height of the turtles' world, in metres."""


class TurtleDriver(PositionController):
    """Drive to the goal of `go_to_goal`; a newer goal preempts an older one."""

    travelled = 0.0
    """Metres since the last goal was set."""

    def is_inside(self, goal: GoToGoal.Goal) -> bool:
        return bool(0 <= goal.position.x <= SIDE and 0 <= goal.position.y <= SIDE)

    @action(GoToGoal, "go_to_goal", policy="preempt", accept=is_inside)
    async def go(self, goal: GoToGoal.Handle) -> GoToGoal.Result:
        started_ns, self.travelled = self.clock.monotonic_ns(), 0.0
        self.go_to(Point(goal.request.position.x, goal.request.position.y))
        try:
            async for _ in self.clock.every(0.1):
                goal.partial = GoToGoal.Result(distance=self.travelled)
                if self.is_there:
                    return goal.partial
                elapsed_ns = self.clock.monotonic_ns() - started_ns
                goal.feedback(GoToGoal.Feedback(elapsed=elapsed_ns / 1e9))
        finally:  # arrived, cancelled or pre-empted
            self.goal = None
            self.cmd_vel.publish(Twist())
        raise AssertionError("every() never ends")

    async def located(self, pose: Pose) -> None:
        if self.pose is not None:
            self.travelled += distance(pose, Point(self.pose.x, self.pose.y))
        self.pose = pose


if __name__ == "__main__":
    graphflow.run(TurtleDriver)
