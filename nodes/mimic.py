"""A turtle that copies another's movements."""

import graphflow
from graphflow import Node, Publisher, subscription
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.turtlesim.msg import Pose


class Mimic(Node):
    """Send the velocities of the turtle on `input/pose` as commands to `output/cmd_vel`."""

    node_name = "turtle_mimic"

    cmd_vel = Publisher(Twist, "output/cmd_vel")

    @subscription(Pose, "input/pose")
    async def moved(self, pose: Pose) -> None:
        speed, turn = Vector3(x=pose.linear_velocity), Vector3(z=pose.angular_velocity)
        self.cmd_vel.publish(Twist(linear=speed, angular=turn))


if __name__ == "__main__":
    graphflow.run(Mimic)
