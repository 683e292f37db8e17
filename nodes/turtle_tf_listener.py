"""A turtle that drives to another frame: it looks up where that is in its own."""

import math

import graphflow
from graphflow import Duration, Node, Param, Publisher, TransformError, timer
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.tf import Transforms


class TurtleTfListener(Node):
    """Drive the turtle `turtlename` to `target_frame`, or to where that was some time ago."""

    turtlename = Param("turtle2", doc="The frame of the turtle that is driven.")
    target_frame = Param("turtle1", doc="The frame it drives to.")
    delay = Param(0.0, unit="s", ge=0.0, le=9.0, doc="How long ago the target was where the turtle drives to.")
    tf = Transforms()
    cmd_vel = Publisher(Twist, "cmd_vel")

    @timer(1.0)
    async def follow(self) -> None:
        now = self.clock.now()
        try:
            if self.delay:
                past = now - Duration.of(self.delay)
                target = await self.tf.lookup(
                    self.turtlename, self.target_frame, past, fixed="world", target_at=now, timeout=0.5
                )
            else:
                target = self.tf.get(self.turtlename, self.target_frame)
        except TransformError as error:
            self.log.info("%s", error, throttle=5.0)
            return
        x, y, _ = target.translation
        turn, speed = math.atan2(y, x), 0.5 * math.hypot(x, y)
        self.cmd_vel.publish(Twist(linear=Vector3(x=speed), angular=Vector3(z=turn)))


if __name__ == "__main__":
    graphflow.run(TurtleTfListener)
