"""A turtle's pose as a transform: where its frame is in the frame `world`."""

import graphflow
from graphflow import Node, Param, subscription
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.tf import Transform, Transforms


class TurtleTfBroadcaster(Node):
    """Send the transform from `world` to the turtle's frame for each of its poses."""

    turtlename = Param("turtle1", doc="The turtle's frame.")
    tf = Transforms(listen=False)

    @subscription(Pose, "pose")
    async def moved(self, pose: Pose) -> None:
        self.tf.send(Transform.of("world", self.turtlename, (pose.x, pose.y, 0.0), rpy=(0.0, 0.0, pose.theta)))


if __name__ == "__main__":
    graphflow.run(TurtleTfBroadcaster)
