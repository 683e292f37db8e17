"""A robot's links and joints, and the poses that the positions of its joints give. Source: the URDF reference."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from graphflow.names import did_you_mean
from graphflow.tf.poses import IDENTITY, Pose, Vector, about

MOVES = {"revolute", "continuous", "prismatic"}
"""The joint types that move; all others are fixed."""


@dataclass(frozen=True, slots=True)
class Shape:
    """The look of a link, or of a part of it.

    Attributes:
        kind: `box`, `cylinder`, `sphere` or `mesh`.
        size: Length, width and height of a box; radius and length of a cylinder; the radius of a sphere; the scale of
            a mesh. In metres.
        mesh: The URI of a mesh, such as `package://my_robot/meshes/base.stl`; "" for other shapes.
        origin: Its pose in the link's frame.
        colour: Red, green, blue and opacity from 0 to 1; None where the description has none.
    """

    kind: str
    size: tuple[float, ...]
    mesh: str
    origin: Pose
    colour: tuple[float, float, float, float] | None


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid part of a robot, which has a frame of the same name."""

    name: str
    visuals: list[Shape]


class Mimic(NamedTuple):
    """The position of a joint that follows another: `factor` times its position, and `offset`."""

    joint: str
    factor: float
    offset: float


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint: it moves the frame `child` in the frame `parent`.

    Attributes:
        kind: `revolute`, `continuous`, `prismatic`, `fixed`, `floating` or `planar`.
        origin: The pose of the child where the joint's position is 0.
        axis: The direction, of length 1, along which or around which it moves.
        limits: The least and greatest position, in radians or metres; None if it has none.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Pose
    axis: Vector
    mimic: Mimic | None
    limits: tuple[float, float] | None

    @property
    def moves(self) -> bool:
        """Whether its position is a number that changes."""
        return self.kind in MOVES

    @property
    def home(self) -> float:
        """The position where it starts: 0, or the middle between its limits if those leave 0 out."""
        if self.limits is None or self.limits[0] <= 0.0 <= self.limits[1]:
            return 0.0
        return sum(self.limits) / 2

    def pose(self, position: float) -> Pose:
        """Return the pose of the child in the parent; the position is in radians or metres."""
        if self.kind == "prismatic":
            x, y, z = self.axis
            return self.origin.of(Pose((x * position, y * position, z * position), IDENTITY.rotation))
        if self.moves:
            return self.origin.of(Pose((0.0, 0.0, 0.0), about(self.axis, position)))
        return self.origin


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot's name, its links and the joints between them, by name.

    Attributes:
        remarks: Sentences on what its description probably does not mean, each with its place.
    """

    name: str
    links: dict[str, Link]
    joints: dict[str, Joint]
    remarks: tuple[str, ...] = ()

    @property
    def root(self) -> str:
        """The link that is no joint's child."""
        children = {joint.child for joint in self.joints.values()}
        return next(link for link in self.links if link not in children)

    def unknown(self, joint: str) -> str:
        """Return the name of a joint that the robot does not have, with the one that is probably meant."""
        return f"{joint!r}{did_you_mean(joint, self.joints)}"

    def moved(self, positions: Mapping[str, float]) -> list[tuple[Joint, float]]:
        """Return the moving joints of which the position is known, with it: those given, and those that mimic them."""
        found = []
        for joint in self.joints.values():
            position = positions.get(joint.name)
            if position is None and joint.mimic is not None and joint.mimic.joint in positions:
                position = positions[joint.mimic.joint] * joint.mimic.factor + joint.mimic.offset
            if position is not None and joint.moves:
                found.append((joint, position))
        return found
