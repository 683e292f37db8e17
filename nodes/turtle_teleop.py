"""A turtle driven with the arrow keys: a task that waits for input from outside the graph.

Topics, timers and services call a node. A keyboard does not, so a `@task` waits for it in the background. When the node
stops, the task is cancelled where it waits, and its `with` block restores the terminal.
"""

from __future__ import annotations

import sys

import graphflow
from graphflow import GraphflowError, Node, Param, Publisher, task
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3

from .terminal_keys import HANGUP, keyboard

PROMPT = """\
Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
'Q' to quit."""

ARROWS = {"up": (1.0, 0.0), "down": (-1.0, 0.0), "left": (0.0, 1.0), "right": (0.0, -1.0)}
"""Components forwards and to the left."""


class TurtleTeleop(Node):
    """Drive turtle1 with the arrow keys; each press sends one command."""

    node_name = "teleop_turtle"

    scale_linear = Param(2.0, unit="m/s", doc="Speed of an arrow up or down.")
    scale_angular = Param(2.0, unit="rad/s", doc="Turning speed of an arrow left or right.")
    cmd_vel = Publisher(Twist, "turtle1/cmd_vel")

    @task
    async def read_keys(self) -> None:
        if sys.stdin is None or not sys.stdin.isatty():
            raise GraphflowError(f"no arrow keys, since this is not a terminal; run {self.name} in its own terminal")
        with keyboard(sys.stdin.fileno()) as keys:
            print(PROMPT, flush=True)
            while (key := await keys.get()) not in ("q", "Q", HANGUP):
                if key in ARROWS:
                    self.drive(*ARROWS[key])
        self.shutdown()

    def drive(self, forward: float, left: float) -> None:
        """Publish one command."""
        linear, angular = self.scale_linear * forward, self.scale_angular * left
        self.cmd_vel.publish(Twist(linear=Vector3(x=linear), angular=Vector3(z=angular)))


if __name__ == "__main__":
    graphflow.run(TurtleTeleop)
