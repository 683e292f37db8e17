"""Errors of real sensors: noisy ranges, encoders with steps, and an odometry that drifts where wheels slip."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from graphflow.simulator.robot import Battery, Lidar, Wheels


def noisy(distances: NDArray[np.float64], lidar: Lidar, dice: np.random.Generator) -> NDArray[np.float32]:
    """Return the ranges that a scanner reports, in metres: infinite where it sees nothing.

    Args:
        distances: The true distances; negative where a beam hits nothing.
    """
    found = distances + dice.normal(0.0, lidar.noise, len(distances)) if lidar.noise else distances.copy()
    lost = (distances < 0) | (found < lidar.range_min) | (found > lidar.range_max)
    if lidar.dropouts:
        lost |= dice.random(len(distances)) < lidar.dropouts
    found[lost] = math.inf
    return found.astype(np.float32)


@dataclass(slots=True)
class Odometry:
    """The pose that the wheels' encoders give, from the start of the robot, with its velocities.

    Attributes:
        x, y, yaw: In metres and radians.
        linear, angular: In m/s and rad/s.
    """

    wheels: Wheels
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    linear: float = 0.0
    angular: float = 0.0
    _left: float = 0.0
    _right: float = 0.0

    def update(self, left: float, right: float, seconds: float) -> None:
        """Take the angles of the wheels in radians after some seconds."""
        left, right = self._seen(left), self._seen(right)
        there, self._left, self._right = (self._left, self._right), left, right
        turned_left, turned_right = (left - there[0]) * self.wheels.radius, (right - there[1]) * self.wheels.radius
        way, turn = (turned_left + turned_right) / 2, (turned_right - turned_left) / self.wheels.separation
        middle = self.yaw + turn / 2
        self.x += way * math.cos(middle)
        self.y += way * math.sin(middle)
        self.yaw = math.remainder(self.yaw + turn, 2 * math.pi)
        # Encoder steps would make the speed jump; a short filter smooths it, as robots' firmware does.
        share = min(1.0, seconds / 0.05)
        self.linear += share * (way / seconds - self.linear)
        self.angular += share * (turn / seconds - self.angular)

    def _seen(self, angle: float) -> float:
        ticks = self.wheels.ticks
        return math.floor(angle / (2 * math.pi) * ticks) * (2 * math.pi) / ticks if ticks else angle


@dataclass(slots=True)
class Charge:
    """A battery's charge.

    Attributes:
        share: From 1 for full to 0 for empty.
        current: In amperes, out of the battery.
    """

    battery: Battery
    share: float = 1.0
    current: float = 0.0

    def update(self, load: float, seconds: float) -> None:
        """Take the load from 0 to 1 over some seconds."""
        self.current = self.battery.idle + self.battery.driving * load
        self.share = max(0.0, self.share - self.current * seconds / 3600 / self.battery.capacity)

    @property
    def voltage(self) -> float:
        """In volts; at the end of the charge a fifth less than at its start."""
        return self.battery.voltage * (0.8 + 0.2 * self.share)
