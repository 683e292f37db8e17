"""Reactive control: a robot that drives about and turns away from what its scanner sees, as a state machine.

The same behaviour is there twice. `EventDriven` decides in the handler of each scan; `TimeDriven` keeps the newest
scan, and decides at a rate of its own. The first reacts at once, and falls silent with its sensor; the second also
notices when no scan comes any more.
"""

from __future__ import annotations

import math
from enum import Enum

import numpy as np

import graphflow
from graphflow import Node, Param, Publisher, Time, subscription, timer
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import SENSOR_DATA


class State(Enum):
    """The robot's activities."""

    DRIVE = "drive"
    TURN_LEFT = "turn left"
    TURN_RIGHT = "turn right"
    STOP = "stop"


def nearest(scan: LaserScan, angle: float, width: float) -> float:
    """Return the shortest range within `width` radians around a direction; infinite if nothing is there."""
    ranges = np.asarray(scan.ranges)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    apart = np.abs(np.remainder(angles - angle + math.pi, 2 * math.pi) - math.pi)
    seen = ranges[(apart <= width / 2) & np.isfinite(ranges) & (ranges >= scan.range_min)]
    return float(seen.min()) if len(seen) else math.inf


class ReactiveControl(Node):
    """The state machine that both forms share."""

    speed = Param(0.15, unit="m/s", gt=0.0, le=0.5, doc="On a free way.")
    turn_speed = Param(0.8, unit="rad/s", gt=0.0, le=2.0, doc="While it turns.")
    safe = Param(0.45, unit="m", gt=0.1, doc="How near something ahead may come before the robot turns.")
    cmd_vel = Publisher(Twist, "cmd_vel")
    states = Publisher(String, "~/state")
    state = State.STOP

    async def on_shutdown(self) -> None:
        self.become(State.STOP)  # else a real robot drives on

    def decide(self, scan: LaserScan) -> State:
        """Return the next state: a turn goes on until the way is free with a margin."""
        ahead = nearest(scan, 0.0, math.radians(60))
        if self.state in (State.TURN_LEFT, State.TURN_RIGHT):
            return State.DRIVE if ahead > 1.2 * self.safe else self.state
        if ahead > self.safe:
            return State.DRIVE
        left, right = nearest(scan, math.radians(60), 1.0), nearest(scan, -math.radians(60), 1.0)
        return State.TURN_LEFT if left > right else State.TURN_RIGHT

    def become(self, state: State) -> None:
        """Take a state, and drive as it demands."""
        if state is not self.state:
            self.log.info("%s", state.value)
            self.states.publish(String(data=state.value))
        self.state = state
        linear = self.speed if state is State.DRIVE else 0.0
        angular = {State.TURN_LEFT: self.turn_speed, State.TURN_RIGHT: -self.turn_speed}.get(state, 0.0)
        self.cmd_vel.publish(Twist(linear=Vector3(x=linear), angular=Vector3(z=angular)))


class EventDriven(ReactiveControl):
    """Decide whenever a scan comes."""

    @subscription(LaserScan, "scan", SENSOR_DATA)
    async def scanned(self, scan: LaserScan) -> None:
        self.become(self.decide(scan))


class TimeDriven(ReactiveControl):
    """Decide ten times a second, and stop when the newest scan is old."""

    patience = Param(0.5, unit="s", gt=0.0, doc="How old a scan may be.")
    scan: LaserScan | None = None

    @subscription(LaserScan, "scan", SENSOR_DATA)
    async def scanned(self, scan: LaserScan) -> None:
        self.scan = scan

    @timer(hz=10.0)
    async def control(self) -> None:
        if self.scan is None:
            return
        age = self.clock.now() - Time.from_msg(self.scan.header.stamp)
        self.become(State.STOP if age.seconds > self.patience else self.decide(self.scan))


if __name__ == "__main__":
    graphflow.run(EventDriven)
