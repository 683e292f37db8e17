"""A frame beside a turtle, like a carrot before a donkey: it stays there, or circles around the turtle."""

import math

import graphflow
from graphflow import Node, Param, timer
from graphflow.tf import Transform, Transforms


class CarrotBroadcaster(Node):
    """Send the transform from `turtle1` to `carrot1`, ten times a second."""

    moves = Param(False, doc="Whether the carrot circles at 10 m; if not, it stays 2 m to the turtle's left.")
    tf = Transforms(listen=False)

    @timer(hz=10.0)
    async def show(self) -> None:
        angle = self.clock.now().seconds * math.pi % (2 * math.pi)
        place = (10.0 * math.sin(angle), 10.0 * math.cos(angle), 0.0) if self.moves else (0.0, 2.0, 0.0)
        self.tf.send(Transform.of("turtle1", "carrot1", place))


if __name__ == "__main__":
    graphflow.run(CarrotBroadcaster)
