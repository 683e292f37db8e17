"""The joints of a robot's URDF description. Source: the URDF reference, `joint`."""

from __future__ import annotations

import math
from typing import NamedTuple
from xml.etree import ElementTree

from graphflow.tf.poses import Pose, Vector, about, from_rpy

MOVES = {"revolute", "continuous", "prismatic"}
"""The joint types that move; all others are fixed."""


class URDFError(ValueError):
    """A text is not a robot description; the message gives the reason."""


class Mimic(NamedTuple):
    """The position of a joint that follows another: `factor` times its position, and `offset`."""

    joint: str
    factor: float
    offset: float


class Joint(NamedTuple):
    """A joint: it moves the frame `child` in the frame `parent`.

    Attributes:
        origin: The pose of the child where the joint's position is 0.
        axis: The direction, of length 1, along which or around which it moves.
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Pose
    axis: Vector
    mimic: Mimic | None

    def pose(self, position: float) -> Pose:
        """Return the pose of the child in the parent; the position is in radians or metres."""
        if self.type == "prismatic":
            x, y, z = self.axis
            return self.origin.of(Pose((x * position, y * position, z * position), (0.0, 0.0, 0.0, 1.0)))
        if self.type in MOVES:
            return self.origin.of(Pose((0.0, 0.0, 0.0), about(self.axis, position)))
        return self.origin


class Robot(NamedTuple):
    """A robot's links, and the joints between them by name."""

    links: list[str]
    joints: dict[str, Joint]


def parse(text: str) -> Robot:
    """Parse a description.

    Raises:
        URDFError: The text is not a robot description.
    """
    try:
        top = ElementTree.fromstring(text)  # noqa: S314 - a robot's description is its user's own
    except ElementTree.ParseError as error:
        raise URDFError(f"it is not XML: {error}") from None
    if top.tag != "robot":
        raise URDFError(f"the root element is <{top.tag}>, not <robot>")
    links = [_name(link) for link in top.findall("link")]
    twice = next((link for i, link in enumerate(links) if link in links[:i]), None)
    if not links or twice is not None:
        raise URDFError("it has no link" if not links else f"there are two links {twice!r}")
    joints: dict[str, Joint] = {}
    for element in top.findall("joint"):
        joint = _joint(element)
        if joint.name in joints:
            raise URDFError(f"there are two joints {joint.name!r}")
        joints[joint.name] = joint
        for end, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                raise URDFError(f"the {end} of the joint {joint.name!r} is {link!r}, which does not exist")
    _check_tree(links, joints)
    for joint in joints.values():
        if joint.mimic is not None and joint.mimic.joint not in joints:
            raise URDFError(f"the joint {joint.name!r} mimics {joint.mimic.joint!r}, which does not exist")
    return Robot(links, joints)


def _check_tree(links: list[str], joints: dict[str, Joint]) -> None:
    above: dict[str, Joint] = {}
    for joint in joints.values():
        if joint.child in above:
            raise URDFError(f"the link {joint.child!r} has two parent joints: {above[joint.child].name}, {joint.name}")
        above[joint.child] = joint
    roots = [link for link in links if link not in above]
    if len(roots) != 1:
        said = f"several roots: {', '.join(roots)}" if roots else "no root: its joints form a cycle"
        raise URDFError(f"its links are not a tree: there are {said}")


def _joint(element: ElementTree.Element) -> Joint:
    name, type_ = _name(element), element.get("type", "")
    if type_ not in {*MOVES, "fixed", "floating", "planar"}:
        raise URDFError(f"the joint {name!r} is of no known type: {type_!r}")
    axis = _numbers(element.find("axis"), "xyz", (1.0, 0.0, 0.0), name)
    length = math.hypot(*axis)
    if type_ in MOVES and length == 0.0:
        raise URDFError(f"the axis of the joint {name!r} has no direction")
    x, y, z = (part / (length or 1.0) for part in axis)
    origin = element.find("origin")
    pose = Pose(
        _numbers(origin, "xyz", (0.0, 0.0, 0.0), name), from_rpy(*_numbers(origin, "rpy", (0.0, 0.0, 0.0), name))
    )
    mimic = element.find("mimic")
    follows = None
    if mimic is not None:
        factor, offset = _number(mimic.get("multiplier", "1"), name), _number(mimic.get("offset", "0"), name)
        follows = Mimic(mimic.get("joint", ""), factor, offset)
    return Joint(name, type_, _link(element, "parent"), _link(element, "child"), pose, (x, y, z), follows)


def _name(element: ElementTree.Element) -> str:
    name = element.get("name")
    if not name:
        raise URDFError(f"a <{element.tag}> has no name")
    return name


def _link(joint: ElementTree.Element, end: str) -> str:
    element = joint.find(end)
    link = None if element is None else element.get("link")
    if not link:
        raise URDFError(f"the joint {joint.get('name')!r} has no {end}")
    return link


def _numbers(element: ElementTree.Element | None, key: str, otherwise: Vector, joint: str) -> Vector:
    text = None if element is None else element.get(key)
    if text is None:
        return otherwise
    numbers = [_number(word, joint) for word in text.split()]
    if len(numbers) != 3:
        raise URDFError(f'{key}="{text}" of the joint {joint!r}: expected three numbers')
    return numbers[0], numbers[1], numbers[2]


def _number(text: str, joint: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise URDFError(f"{text!r} at the joint {joint!r} is not a number") from None
    if not math.isfinite(number):
        raise URDFError(f"{text!r} at the joint {joint!r} is not finite")
    return number
