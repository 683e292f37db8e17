"""The description of a robot in URDF, from its numbers, for tools that draw robots."""

from __future__ import annotations

import math
from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from graphflow.simulator.robot import Robot

BODY, WHEEL, SENSOR = "0.25 0.28 0.32 1", "0.1 0.1 0.1 1", "0.8 0.3 0.2 1"
"""Colours: red, green, blue, opacity."""
WHEEL_WIDTH = 0.018
JOINTS = ("wheel_left_joint", "wheel_right_joint")


def described(robot: Robot, prefix: str = "") -> str:
    """Return the description of a robot.

    Args:
        prefix: What precedes the names of its frames, such as `second/`.
    """
    root = Element("robot", name=robot.name)
    base, footprint, height = prefix + robot.base_frame, prefix + robot.footprint_frame, robot.base_height
    SubElement(root, "link", name=footprint)
    link = SubElement(root, "link", name=base)
    size = robot.base.size
    if size is not None:
        solid = {"tag": "box", "size": _text(size)}
    else:
        solid = {"tag": "cylinder", "radius": _text([robot.base.radius or 0.1]), "length": _text([robot.base.height])}
    x, y, z = robot.base.at
    _visual(link, solid, [x, y, z - height], BODY)
    _joint(root, "base_joint", footprint, base, [0.0, 0.0, height])
    wheels = robot.wheels
    for name, side, place in zip(
        JOINTS, ("left", "right"), (wheels.separation / 2, -wheels.separation / 2), strict=True
    ):
        wheel = SubElement(root, "link", name=f"{prefix}wheel_{side}_link")
        solid = {"tag": "cylinder", "radius": _text([wheels.radius]), "length": _text([WHEEL_WIDTH])}
        _visual(wheel, solid, [0.0, 0.0, 0.0], WHEEL)
        # The axle is the wheel's z axis, as in the TurtleBot3's description.
        joint = _joint(root, name, base, wheel.get("name", ""), [0.0, place, wheels.radius - height], "continuous")
        joint[2].set("rpy", _text([-math.pi / 2, 0.0, 0.0]))
        SubElement(joint, "axis", xyz="0 0 1")
    for name, sensor in (("scan", robot.lidar), ("imu", robot.imu)):
        if sensor is not None:
            link = SubElement(root, "link", name=prefix + sensor.frame)
            if name == "scan":
                _visual(link, {"tag": "cylinder", "radius": "0.035", "length": "0.04"}, [0.0, 0.0, 0.0], SENSOR)
            at = [sensor.at[0], sensor.at[1], sensor.at[2] - height]
            _joint(root, f"{name}_joint", base, prefix + sensor.frame, at)
    indent(root)
    return tostring(root, encoding="unicode")


def _visual(link: Element, solid: dict[str, str], at: Sequence[float], colour: str) -> None:
    visual = SubElement(link, "visual")
    SubElement(visual, "origin", xyz=_text(at), rpy="0 0 0")
    attributes = dict(solid)
    SubElement(SubElement(visual, "geometry"), attributes.pop("tag"), attributes)
    SubElement(SubElement(visual, "material", name=""), "color", rgba=colour)


def _joint(root: Element, name: str, parent: str, child: str, at: Sequence[float], type_: str = "fixed") -> Element:
    joint = SubElement(root, "joint", name=name, type=type_)
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    SubElement(joint, "origin", xyz=_text(at), rpy="0 0 0")
    return joint


def _text(numbers: Sequence[float]) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)
