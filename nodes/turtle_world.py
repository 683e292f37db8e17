"""The world of turtlesim, without a node: turtles, their commanded velocities, and the walls around them.

A turtle is a unicycle: it moves along its heading and turns on the spot. The owner of the world calls `step` every 16
ms with the time, which only serves to expire commands: a turtle stops a second after its last one. `nodes/turtlesim.py`
connects the world to the network.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from .turtle_canvas import Canvas, Pen, Position

TICK = 0.016
"""Seconds between two steps: 62.5 Hz."""
SIZE = 11.088889122009277
"""Metres from wall to wall: 499 pixels of 45 to the metre, rounded to float32 as turtlesim does."""
COMMAND_LIFE_NS = 1_000_000_000
"""Nanoseconds that a velocity command lasts."""
DEGREES = 5
"""Angles in degrees are mostly multiples of this."""
LIMIT = 1e5
"""Limit of a turtle's position and speed, in metres, radians and seconds."""


class NameTaken(Exception):
    """There is already a turtle of that name."""


@dataclass
class Turtle:
    """A turtle's pose, velocity and pen. Metres and radians; theta 0 points along x."""

    name: str
    x: float
    y: float
    theta: float = 0.0
    number: int = 0
    """The turtle's number since the last reset, which determines its colour."""
    pen: Pen | None = field(default_factory=Pen)
    """The pen; None while it is lifted."""
    forward: float = 0.0
    sideways: float = 0.0
    turning: float = 0.0
    commanded_ns: int = 0

    @property
    def position(self) -> Position:
        return self.x, self.y

    @property
    def speed(self) -> float:
        return math.hypot(self.forward, self.sideways)

    def command(self, forward: float, sideways: float, turning: float, now_ns: int) -> None:
        """Set the velocities (m/s forward, m/s to the left, rad/s) from the next step on.

        Raises:
            ValueError: A velocity is not a number, or is beyond `LIMIT`.
        """
        check_numbers(forward, sideways, turning)
        self.forward, self.sideways, self.turning, self.commanded_ns = forward, sideways, turning, now_ns

    def move(self, seconds: float) -> None:
        """Move for a number of seconds at the current velocities, turning first."""
        self.theta = normalize(self.theta + self.turning * seconds)
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        self.x += (cos * self.forward - sin * self.sideways) * seconds
        self.y += (sin * self.forward + cos * self.sideways) * seconds


class World:
    """Turtles by name, and their drawing."""

    def __init__(self) -> None:
        self.turtles: dict[str, Turtle] = {}
        self.canvas = Canvas()
        self._numbered = 0
        self._spawned = 0

    def free_name(self) -> str:
        """Return the next free name: `turtle1`, `turtle2`, ... A number is never reused."""
        while True:
            self._numbered += 1
            if (name := f"turtle{self._numbered}") not in self.turtles:
                return name

    def spawn(self, name: str, x: float, y: float, theta: float) -> Turtle:
        """Add a turtle.

        Raises:
            NameTaken: There is already one of that name.
            ValueError: A coordinate is not a number, or is beyond `LIMIT`.
        """
        check_numbers(x, y, theta)
        if name in self.turtles:
            raise NameTaken(name)
        turtle = Turtle(name, x, y, theta, number=self._spawned)
        self.turtles[name] = turtle
        self._spawned += 1
        return turtle

    def kill(self, name: str) -> None:
        """Remove a turtle. Its drawing stays.

        Raises:
            KeyError: There is no turtle of that name.
        """
        del self.turtles[name]

    def step(self, turtle: Turtle, now_ns: int) -> Position | None:
        """Advance a turtle by one tick.

        Returns:
            None, or the position it would have reached without a wall.
        """
        if now_ns - turtle.commanded_ns > COMMAND_LIFE_NS:
            turtle.forward = turtle.sideways = turtle.turning = 0.0
        before = turtle.position
        turtle.move(TICK)
        beyond = turtle.position
        turtle.x, turtle.y = (min(max(v, 0.0), SIZE) for v in beyond)
        self._draw(turtle, before)
        return None if turtle.position == beyond else beyond

    def teleport(self, turtle: Turtle, x: float, y: float, theta: float) -> None:
        """Put a turtle elsewhere; its pen draws a straight line there.

        Raises:
            ValueError: A coordinate is not a number, or is beyond `LIMIT`.
        """
        check_numbers(x, y, theta)
        before = turtle.position
        turtle.x, turtle.y, turtle.theta = x, y, theta
        self._draw(turtle, before)

    def jump(self, turtle: Turtle, distance: float, turn: float) -> None:
        """Turn a turtle, then put it `distance` ahead. Errors as for `teleport`."""
        check_numbers(distance, turn)
        theta = turtle.theta + turn
        x, y = turtle.x + distance * math.cos(theta), turtle.y + distance * math.sin(theta)
        self.teleport(turtle, x, y, theta)

    def clear(self) -> None:
        """Wipe the canvas."""
        self.canvas = Canvas()

    def _draw(self, turtle: Turtle, before: Position) -> None:
        if turtle.pen is not None and turtle.position != before:
            self.canvas.draw(turtle.name, turtle.pen, before, turtle.position)


def check_numbers(*values: float) -> None:
    """Raise ValueError unless all values are numbers within `LIMIT`."""
    for value in values:
        if not abs(value) < LIMIT:  # also true of a NaN
            raise ValueError(f"{value} is out of a turtle's range: give a number between {-LIMIT:g} and {LIMIT:g}")


def in_degrees(angle: float, before: float = 0.0) -> bool:
    """Whether an angle in radians seems to be given in degrees: 90, but not the next of a series such as 9.5, 10.0.

    Args:
        before: The angle given before it.
    """
    return abs(angle) > math.tau and angle % DEGREES == 0 and abs(angle - before) > math.tau


def normalize(angle: float) -> float:
    """Return the same angle from -pi up to but not including pi."""
    return angle - math.tau * math.floor((angle + math.pi) / math.tau)
