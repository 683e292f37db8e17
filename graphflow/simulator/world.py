"""Worlds: a floor with walls, boxes, cylinders, polygons, moving obstacles, maps, scenes and robots."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import AfterValidator, Field, StrictStr, field_validator, model_validator

from graphflow.errors import InvalidName
from graphflow.names import check_node_name
from graphflow.simulator.robot import Model, NotNegative, Number, Positive

EDGE = 100.0
"""Metres from the origin, along x and y, at which the world ends."""


def _within(point: list[float]) -> list[float]:
    far = max(map(abs, point))
    if far > EDGE:
        hint = f": are these millimetres? {far:g} mm are {far / 1000:g} m" if far >= 10 * EDGE else ""
        raise ValueError(f"{point} lies beyond the end of the world, {EDGE:g} m from its middle{hint}")
    return point


def _as_angle(yaw: float) -> float:
    if abs(yaw) > 2 * math.tau:
        raise ValueError(f"yaw is in radians; {yaw:g} degrees are {math.radians(yaw):.4g}")
    return yaw


Point = Annotated[list[Number], Field(min_length=2, max_length=2), AfterValidator(_within)]
"""x and y in metres."""
Yaw = Annotated[Number, AfterValidator(_as_angle)]
"""Radians."""
Path = Annotated[list[Point], Field(min_length=2)]
OBSTACLES_BOUND = 2_000
"""The number of obstacles of a world, at most."""
ROBOTS_BOUND = 100
"""The number of robots, at most."""


def _namespace(name: str) -> str:
    if name:
        try:
            check_node_name(name)
        except InvalidName as error:
            raise ValueError(str(error)) from None
    return name


class Wall(Model):
    """A straight wall, or several in a row.

    Attributes:
        points: The corners.
        closed: Whether a wall leads from the last corner back to the first.
    """

    points: Path
    closed: bool = False
    height: Positive = 0.5
    thickness: Positive = 0.1

    @model_validator(mode="after")
    def _check(self) -> Self:
        for (x, y), (u, v) in zip(self.points, self.points[1:], strict=False):
            if math.hypot(u - x, v - y) < 1e-6:
                raise ValueError(f"two neighbouring points of the wall are the same: [{x:g}, {y:g}]")
        return self


class Box(Model):
    """A box that stands on the floor.

    Attributes:
        size: Length, width and height in metres.
        yaw: Radians.
    """

    at: Point
    size: Annotated[list[Positive], Field(min_length=3, max_length=3)]
    yaw: Yaw = 0.0
    mass: NotNegative = 0.0
    """Kilograms; 0 for a box that nothing can push."""


class Cylinder(Model):
    """An upright cylinder that stands on the floor."""

    at: Point
    radius: Positive
    height: Positive = 0.5
    mass: NotNegative = 0.0
    """Kilograms; 0 for a cylinder that nothing can push."""


class Mover(Model):
    """A cylinder that moves along a path and back to its start, at a speed in m/s."""

    path: Path
    speed: Positive
    radius: Positive = 0.15
    height: Positive = 0.5


class MapWalls(Model):
    """Walls from the occupied cells of a map.

    Attributes:
        file: The map's YAML file, beside the world's.
    """

    file: StrictStr
    height: Positive = 0.5


class Placed(Model):
    """A robot in the world.

    Attributes:
        model: A bundled robot such as `burger`, or a robot file beside the world's.
        name: Its namespace; "" for none, which one robot may have.
        at, yaw: Where it starts, in metres and radians.
    """

    model: StrictStr = "burger"
    name: Annotated[StrictStr, AfterValidator(_namespace)] = ""
    at: Point = Field([0.0, 0.0])
    yaw: Yaw = 0.0


class World(Model):
    """A world file."""

    walls: list[Wall] = Field([], max_length=OBSTACLES_BOUND)
    boxes: list[Box] = Field([], max_length=OBSTACLES_BOUND)
    cylinders: list[Cylinder] = Field([], max_length=OBSTACLES_BOUND)
    moving: list[Mover] = Field([], max_length=OBSTACLES_BOUND)
    map: MapWalls | None = None
    scene: StrictStr = ""
    """A file of MuJoCo (MJCF) or URDF, beside the world's, that is part of the world as it is."""
    robots: list[Placed] = Field([], max_length=ROBOTS_BOUND)
    friction: Positive = 1.0
    """Of the floor; on ice, below 0.1, wheels slip."""

    @field_validator("robots")
    @classmethod
    def _check_names(cls, robots: list[Placed]) -> list[Placed]:
        names = [robot.name for robot in robots]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two robots are called {name!r}: give each a name of its own" if name else _UNNAMED)
        return robots


_UNNAMED = "two robots have no name: their topics would be the same; give each a name"
