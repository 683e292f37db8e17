"""Ten turtles in circles: services called when the node starts, and publishers made at run time.

The simulator and this node, in two terminals:

    graphflow run nodes.turtlesim:TurtleSim
    graphflow run nodes.ten_turtles:TenTurtles
"""

from __future__ import annotations

import graphflow
from graphflow import Client, Node, Param, TopicPublisher, timer
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.turtlesim.srv import Spawn


class TenTurtles(Node):
    """Spawn turtles in a row and drive each in its own circle."""

    count = Param(10, ge=1, le=50, read_only=True, doc="How many turtles.")
    spawn_turtle = Client(Spawn, "spawn")
    dynamic_names = ("*/cmd_vel",)  # the simulator chooses the turtles' names

    async def on_start(self) -> None:
        self.cmd_vel: list[TopicPublisher[Twist]] = []
        await self.spawn_turtle.wait_ready()
        for i in range(self.count):
            turtle = await self.spawn_turtle.call(Spawn.Request(x=1.0 + 9.0 * i / self.count, y=5.5))
            self.cmd_vel.append(self.create_publisher(Twist, f"{turtle.name}/cmd_vel"))
            self.log.info("spawned %s", turtle.name)

    @timer(hz=10.0)
    async def drive(self) -> None:
        for i, cmd_vel in enumerate(self.cmd_vel):
            cmd_vel.publish(Twist(linear=Vector3(x=1.0), angular=Vector3(z=1.0 + 0.1 * i)))


if __name__ == "__main__":
    graphflow.run(TenTurtles)
