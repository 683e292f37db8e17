"""A robot driven with the keys of TurtleBot3's teleop_keyboard: each press changes the speed by a step.

The velocity is sent ten times a second, since robots stop when their commands stop.
"""

from __future__ import annotations

import os
import sys

import graphflow
from graphflow import GraphflowError, Node, Param, Publisher, task, timer
from graphflow.msgs.geometry_msgs.msg import Twist, TwistStamped, Vector3
from graphflow.msgs.std_msgs.msg import Header

from .terminal_keys import HANGUP, keyboard

PROMPT = """\
Control Your TurtleBot3!
---------------------------
Moving around:
        w
   a    s    d
        x

w/x : increase/decrease linear velocity (Burger : ~ 0.22, Waffle : ~ 0.26)
a/d : increase/decrease angular velocity (Burger : ~ 2.84, Waffle : ~ 1.82)
space key, s : force stop

'Q' or CTRL-C to quit"""
LIMITS = {"burger": (0.22, 2.84), "waffle": (0.26, 1.82), "waffle_pi": (0.26, 1.82)}
"""Highest speeds in m/s and rad/s, by the value of TURTLEBOT3_MODEL."""
STEPS = {"w": (0.01, 0.0), "x": (-0.01, 0.0), "a": (0.0, 0.1), "d": (0.0, -0.1)}
STEPS |= {"up": STEPS["w"], "down": STEPS["x"], "left": STEPS["a"], "right": STEPS["d"]}
"""Changes of the speeds by key."""


class RobotTeleop(Node):
    """Drive a robot from a terminal."""

    node_name = "teleop_keyboard"

    model = Param(os.environ.get("TURTLEBOT3_MODEL", "burger"), choices=sorted(LIMITS), doc="Whose limits count.")
    stamped = Param(False, read_only=True, doc="Whether the robot takes a TwistStamped.")
    cmd_vel = Publisher(Twist, "cmd_vel")
    linear = 0.0
    angular = 0.0

    async def on_start(self) -> None:
        if self.stamped:
            self.cmd_vel.close()
            self.stamped_cmd_vel = self.create_publisher(TwistStamped, "cmd_vel", 10)

    @task
    async def read_keys(self) -> None:
        if sys.stdin is None or not sys.stdin.isatty():
            raise GraphflowError(f"no keys, since this is not a terminal; run {self.name} in its own terminal")
        with keyboard(sys.stdin.fileno()) as keys:
            print(PROMPT, flush=True)
            while (key := await keys.get()) not in ("q", "Q", HANGUP):
                self.press(key)
        self.shutdown()

    async def on_shutdown(self) -> None:
        self.linear = self.angular = 0.0
        self.send()  # else a real robot drives on

    def press(self, key: str) -> None:
        """Change the speeds by one key."""
        if key in (" ", "s"):
            self.linear = self.angular = 0.0
        elif key in STEPS:
            most, turn = LIMITS[self.model]
            self.linear = round(min(most, max(-most, self.linear + STEPS[key][0])), 3)
            self.angular = round(min(turn, max(-turn, self.angular + STEPS[key][1])), 3)
        else:
            return
        print(f"currently:\tlinear velocity {self.linear:g}\tangular velocity {self.angular:g}", flush=True)

    @timer(0.1)
    async def drive(self) -> None:
        self.send()

    def send(self) -> None:
        """Publish the present speeds."""
        twist = Twist(linear=Vector3(x=self.linear), angular=Vector3(z=self.angular))
        if self.stamped:
            self.stamped_cmd_vel.publish(TwistStamped(header=Header(stamp=self.clock.now()), twist=twist))
        else:
            self.cmd_vel.publish(twist)


if __name__ == "__main__":
    graphflow.run(RobotTeleop)
