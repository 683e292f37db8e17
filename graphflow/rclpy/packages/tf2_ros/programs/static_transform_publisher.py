#!/usr/bin/env python3
"""Publish a constant transform between two frames on `/tf_static`.

Source: tf2_ros static_transform_publisher, its arguments and parameters.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from uuid import uuid4

from rcl_interfaces.msg import ParameterDescriptor
from tf2_py.core import message
from tf2_ros import StaticTransformBroadcaster

import rclpy
from graphflow.tf.poses import Pose, Quaternion, from_rpy
from rclpy.executors import ExternalShutdownException
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

METRES, TURNS, PARTS = ("x", "y", "z"), ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")
"""The numeric options: a translation, and a rotation in radians or as a quaternion."""
_FORMS = (
    "the old form is X Y Z YAW PITCH ROLL PARENT CHILD, or X Y Z QX QY QZ QW PARENT CHILD; the new one names what is "
    "not 0: --z 0.2 --frame-id base_link --child-frame-id laser"
)


class StaticTransformPublisher(Node):
    """Publishes one transform for as long as it runs; its parameters define it, and are read-only."""

    def __init__(self, pose: Pose, parent: str, child: str) -> None:
        super().__init__(f"static_transform_publisher_{uuid4().hex[:16]}")
        fixed = ParameterDescriptor(read_only=True)

        def numbers(group: str, names: str, values: Sequence[float]) -> list[float]:
            pairs = zip(names, values, strict=True)
            return [float(self.declare_parameter(f"{group}.{n}", v, fixed).value) for n, v in pairs]

        x, y, z = numbers("translation", "xyz", pose.translation)
        a, b, c, w = numbers("rotation", "xyzw", pose.rotation)
        parent = self.declare_parameter("frame_id", parent, fixed).value
        child = self.declare_parameter("child_frame_id", child, fixed).value
        if parent == child:
            raise ValueError(f"cannot publish static transform from '{parent}' to '{child}', exiting")
        pose = Pose((x, y, z), _normalized((a, b, c, w)))
        self._broadcaster = StaticTransformBroadcaster(self)
        self._broadcaster.sendTransform(message(pose, parent, child, self.get_clock().now().nanoseconds))
        moved = ", ".join(f"'{value:.6f}'" for value in pose.translation)
        turned = ", ".join(f"'{value:.6f}'" for value in pose.rotation)
        self.get_logger().info(
            "Spinning until stopped - publishing transform\n"
            f"translation: ({moved})\nrotation: ({turned})\nfrom '{parent}' to '{child}'"
        )


def _normalized(q: Quaternion) -> Quaternion:
    length = math.hypot(*q)
    if not math.isfinite(length) or length == 0.0:
        raise ValueError(f"{q} is not a rotation: the length of the quaternion is {length}")
    x, y, z, w = (part / length for part in q)
    return x, y, z, w


def _number(word: str) -> float:
    """Parse a number. Raises ArgumentTypeError if it is not a finite number."""
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{word!r} is not a finite number")
    return number


def parsed(words: Sequence[str]) -> tuple[Pose, str, str]:
    """Return the pose, parent frame and child frame that a command line specifies.

    Raises:
        SystemExit: The command line is wrong.
    """
    parser = argparse.ArgumentParser(
        "static_transform_publisher",
        description="Publish a constant transform between two frames.",
        allow_abbrev=False,
    )
    for names, unit in ((METRES, "METRES"), (TURNS, "RADIANS"), (PARTS, "NUMBER")):
        for name in names:
            parser.add_argument(f"--{name}", type=_number, metavar=unit)
    parser.add_argument("--frame-id", help="the parent frame; required")
    parser.add_argument("--child-frame-id", help="the child frame; required")
    if len(words) in (9, 10) and not any(word.startswith("--") for word in words) and words[-1].isdigit():
        words = words[:-1]  # ROS 1's period
    if len(words) in (8, 9) and not any(word.startswith("--") for word in words):
        get_logger("static_transform_publisher").warning(
            "Old-style arguments are deprecated; see --help for new-style arguments"
        )
        options = (*METRES, *(reversed(TURNS) if len(words) == 8 else PARTS), "frame-id", "child-frame-id")
        words = [f"--{option}={word}" for option, word in zip(options, words, strict=True)]
    found, others = parser.parse_known_args(_with_values(words))
    if others:
        parser.error(f"unrecognized arguments: {' '.join(others)}; {_FORMS}")
    if not found.frame_id or not found.child_frame_id:
        parser.error("--frame-id and --child-frame-id are required")
    turns, parts = ([getattr(found, name) for name in names] for names in (TURNS, PARTS))
    if any(turn is not None for turn in turns) and any(part is not None for part in parts):
        parser.error("give --roll, --pitch and --yaw, or --qx, --qy, --qz and --qw, but not both")
    x, y, z = (getattr(found, name) or 0.0 for name in METRES)
    if any(part is not None for part in parts):
        a, b, c, w = (usual if part is None else part for part, usual in zip(parts, (0.0, 0.0, 0.0, 1.0), strict=True))
    else:
        roll, pitch, yaw = (turn or 0.0 for turn in turns)
        for name, turn in (("roll", roll), ("pitch", pitch), ("yaw", yaw)):
            if abs(turn) > math.tau:
                text = f"--{name} is in radians: {turn:g} degrees are {math.radians(turn):.4g}"
                get_logger("static_transform_publisher").warning(text)
        a, b, c, w = from_rpy(roll, pitch, yaw)
    return Pose((x, y, z), (a, b, c, w)), found.frame_id, found.child_frame_id


def _with_values(words: Sequence[str]) -> list[str]:
    """Join each option with its value: argparse takes `-1e-3` for an option."""
    joined: list[str] = []
    rest = iter(words)
    for word in rest:
        is_number = word.startswith("--") and word[2:] in (*METRES, *TURNS, *PARTS)
        value = next(rest, None) if is_number else None
        joined.append(word if value is None else f"{word}={value}")
    return joined


def main() -> None:
    """Run the program."""
    rclpy.init()
    pose, parent, child = parsed(remove_ros_args(sys.argv)[1:])
    try:
        rclpy.spin(StaticTransformPublisher(pose, parent, child))
    except ValueError as error:
        sys.exit(f"error: static_transform_publisher: {error}")
    except (KeyboardInterrupt, ExternalShutdownException):
        return


if __name__ == "__main__":
    main()
