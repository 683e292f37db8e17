"""A turtle that follows another: a node class that inherits another."""

import graphflow
from graphflow import subscription
from graphflow.msgs.turtlesim.msg import Pose

from .position_controller import Point, PositionController


class TurtleFollower(PositionController):
    """Drive to the turtle on `goal`."""

    @subscription(Pose, "goal")
    async def goal_moved(self, pose: Pose) -> None:
        self.goal = Point(pose.x, pose.y)


if __name__ == "__main__":
    graphflow.run(TurtleFollower)
