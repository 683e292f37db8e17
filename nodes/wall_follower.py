"""A robot that drives along the wall on its right, as a state machine: find a wall, turn along it, follow it."""

from __future__ import annotations

import math
from enum import Enum

import graphflow
from graphflow import Node, Param, Publisher, subscription
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import SENSOR_DATA

from .reactive_control import nearest


class State(Enum):
    """The robot's activities."""

    FIND = "find a wall"
    TURN = "turn left, along the wall"
    FOLLOW = "follow the wall"


class WallFollower(Node):
    """Keep a wall on the right at a distance."""

    distance = Param(0.4, unit="m", gt=0.15, le=2.0, doc="From the wall.")
    speed = Param(0.15, unit="m/s", gt=0.0, le=0.5, doc="Along the wall.")
    gain = Param(3.0, gt=0.0, doc="How hard the robot steers against a wrong distance.")
    cmd_vel = Publisher(Twist, "cmd_vel")
    states = Publisher(String, "~/state")
    state = State.FIND

    async def on_shutdown(self) -> None:
        self.cmd_vel.publish(Twist())  # else a real robot drives on

    @subscription(LaserScan, "scan", SENSOR_DATA)
    async def scanned(self, scan: LaserScan) -> None:
        ahead, right = nearest(scan, 0.0, math.radians(50)), nearest(scan, math.radians(-90), math.radians(60))
        front_right = nearest(scan, math.radians(-45), math.radians(40))
        self.become(self.decide(ahead, min(right, front_right)))
        self.drive(right, front_right)

    def decide(self, ahead: float, beside: float) -> State:
        """Return the next state from the ranges ahead and on the right, in metres."""
        if ahead < self.distance * (1.3 if self.state is State.TURN else 1.0):
            return State.TURN
        return State.FOLLOW if beside < 2.5 * self.distance else State.FIND

    def become(self, state: State) -> None:
        """Take a state, and tell of it."""
        if state is not self.state:
            self.log.info("%s", state.value)
            self.states.publish(String(data=state.value))
        self.state = state

    def drive(self, right: float, front_right: float) -> None:
        """Drive as the state demands."""
        linear, angular = self.speed, 0.0
        if self.state is State.TURN:
            linear, angular = 0.0, 0.8
        elif self.state is State.FOLLOW:
            # The wall ahead on the right tells early of a bend; it is seen at 45 degrees.
            wrong = min(right, front_right * math.cos(math.radians(45)) * 1.1) - self.distance
            angular = max(-0.8, min(0.8, -self.gain * wrong))
            linear = self.speed * (1.0 - 0.5 * min(1.0, abs(angular)))
        self.cmd_vel.publish(Twist(linear=Vector3(x=linear), angular=Vector3(z=angular)))


if __name__ == "__main__":
    graphflow.run(WallFollower)
