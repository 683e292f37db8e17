"""A robot driven with the keys of ROS's teleop_twist_keyboard: each key is a direction, as long as it is held."""

from __future__ import annotations

import sys

import graphflow
from graphflow import GraphflowError, Node, Param, Publisher, task
from graphflow.msgs.geometry_msgs.msg import Twist, TwistStamped, Vector3
from graphflow.msgs.std_msgs.msg import Header

from .terminal_keys import HANGUP, keyboard

PROMPT = """\
This node takes keypresses from the keyboard and publishes them as Twist messages.
---------------------------
Moving around:
   u    i    o
   j    k    l
   m    ,    .

q/z : increase/decrease max speeds by 10%
w/x : increase/decrease only linear speed by 10%
e/c : increase/decrease only angular speed by 10%
anything else : stop
Hold a key to drive on: a robot may stop 1 s after the last message.

CTRL-C to quit"""
MOVES = {"i": (1, 0), "o": (1, -1), "j": (0, 1), "l": (0, -1), "u": (1, 1), ",": (-1, 0), ".": (-1, 1), "m": (-1, -1)}
MOVES |= {"up": MOVES["i"], "down": MOVES[","], "left": MOVES["j"], "right": MOVES["l"]}
"""Directions ahead and to the left, by key."""
SPEEDS = {"q": (1.1, 1.1), "z": (0.9, 0.9), "w": (1.1, 1.0), "x": (0.9, 1.0), "e": (1.0, 1.1), "c": (1.0, 0.9)}
"""Factors of the speeds, by key."""


class TwistTeleop(Node):
    """Drive a robot from a terminal."""

    node_name = "teleop_twist_keyboard"

    speed = Param(0.5, unit="m/s", gt=0.0, doc="Ahead and backwards.")
    turn = Param(1.0, unit="rad/s", gt=0.0, doc="To the left and to the right.")
    stamped = Param(False, read_only=True, doc="Whether the robot takes a TwistStamped.")
    frame_id = Param("", read_only=True, doc="The frame of stamped messages.")
    cmd_vel = Publisher(Twist, "cmd_vel")

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
            while (key := await keys.get()) != HANGUP:
                self.press(key)
        self.shutdown()

    async def on_shutdown(self) -> None:
        self.send(0.0, 0.0)  # else a real robot drives on

    def press(self, key: str) -> None:
        """Drive in a direction, change the speeds, or stop."""
        if key in SPEEDS:
            linear, angular = SPEEDS[key]
            self.speed, self.turn = round(self.speed * linear, 3), round(self.turn * angular, 3)
            print(f"currently:\tspeed {self.speed:g}\tturn {self.turn:g}", flush=True)
            return
        ahead, left = MOVES.get(key, (0, 0))
        self.send(ahead * self.speed, left * self.turn)

    def send(self, linear: float, angular: float) -> None:
        """Publish a velocity."""
        twist = Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))
        if self.stamped:
            header = Header(stamp=self.clock.now(), frame_id=self.frame_id)
            self.stamped_cmd_vel.publish(TwistStamped(header=header, twist=twist))
        else:
            self.cmd_vel.publish(twist)


if __name__ == "__main__":
    graphflow.run(TwistTeleop)
