"""A turtle in a circle, a common first exercise: two parameters, a publisher and a timer.

Driving at v metres and turning at w radians a second makes a circle with a radius of v / w metres. The command
is repeated, since turtles, like real robots, stop after a second without one.
"""

import graphflow
from graphflow import Node, Param, Publisher, timer
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3


class DrawCircle(Node):
    """Drive turtle1 in a circle."""

    linear = Param(2.0, unit="m/s", doc="Speed along the circle.")
    angular = Param(1.8, unit="rad/s", doc="Turning speed; more than 0 is to the left.")
    cmd_vel = Publisher(Twist, "turtle1/cmd_vel")

    @timer(hz=10.0)
    async def drive(self) -> None:
        self.cmd_vel.publish(Twist(linear=Vector3(x=self.linear), angular=Vector3(z=self.angular)))


if __name__ == "__main__":
    graphflow.run(DrawCircle)
