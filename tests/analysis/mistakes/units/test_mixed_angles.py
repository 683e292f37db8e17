"""Degrees that are mixed with radians."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.units.mixed_angles import mixed_angles

TURTLE = """
import math
from math import atan2, degrees
from graphflow.msgs.turtlesim.msg import Pose


class Turtle(Node):
    pose = None
    heading = 0.0
    wanted = Param(90.0, unit="deg")
    turn = Param(1.5, unit="rad")
    bare = Param(90.0)

    @subscription(Pose, "pose")
    async def heard(self, m):
        self.pose = m
        self.heading = math.degrees(m.theta)

    @timer(0.1)
    def control(self, given, there: Pose):
        angle = math.degrees(math.atan2(1.0, 2.0))
        pose = self.pose
        goal = Target()
        {}
"""
BOTH = "{} is in degrees, and {} in radians; write both in radians"
PLAIN = "{0} is in degrees, and {1} in radians; write math.radians({0})"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("error = angle - self.pose.theta", PLAIN.format("angle", "self.pose.theta")),
        ("error = pose.theta - angle", PLAIN.format("angle", "pose.theta")),
        ("error = there.theta + -degrees(given)", BOTH.format("-degrees(given)", "there.theta")),
        ("error = math.degrees(given) - atan2(1, 2)", BOTH.format("math.degrees(given)", "atan2(1, 2)")),
        ("error = np.rad2deg(given) - np.arctan2(1, 2)", BOTH.format("np.rad2deg(given)", "np.arctan2(1, 2)")),
        ("if abs(self.heading) > math.radians(90): go()", BOTH.format("abs(self.heading)", "math.radians(90)")),
        ("error = 2.0 * (self.wanted - pose.theta)", PLAIN.format("self.wanted", "pose.theta")),
        ("error = self.wanted - self.turn", PLAIN.format("self.wanted", "self.turn")),
        ("x = math.cos(self.wanted)", "self.wanted is in degrees, and cos takes radians"),
        ("x = math.cos(self.heading)", "self.heading is in degrees, and cos takes radians"),
    ],
)
def test_degrees_and_radians(line: str, told: str) -> None:
    """Are told where they are added, subtracted or compared."""
    assert [text for _, text in mixed_angles(ast.parse(TURTLE.format(line)))] == [told]


@pytest.mark.parametrize(
    "line",
    [
        "error = math.atan2(1.0, 2.0) - self.pose.theta",
        "error = math.degrees(math.atan2(1.0, 2.0) - self.pose.theta)",
        "error = angle - math.degrees(self.pose.theta)",
        "error = math.radians(self.wanted) - pose.theta",
        "error = self.wanted - math.degrees(pose.theta)",
        "error = self.turn - pose.theta",
        "error = angle - 90.0",
        "error = math.sin(math.radians(angle))",
        "error = math.radians(angle) - pose.theta",
        "self.log.info('%f %f', angle, pose.theta)",
    ],
)
def test_angles_that_fit(line: str) -> None:
    """They are of one unit, or only shown together."""
    assert mixed_angles(ast.parse(TURTLE.format(line))) == ()


@pytest.mark.parametrize(
    "line",
    [
        "error = angle - goal.theta",
        "error = angle - given.theta",
        "error = angle - given",
        "error = angle - np.angle(given)",
        "error = self.bare - pose.theta",
        "error = 2.0 * (self.wanted - m.theta)",
        "angle = math.radians(angle)\n        error = angle - pose.theta",
        "self.pose.theta = degrees(given)\n        error = angle - pose.theta",
        "self.degrees = Servo()\n        error = self.degrees(given) - pose.theta",
        "angle += pose.theta",
    ],
)
def test_angles_whose_unit_is_not_seen(line: str) -> None:
    """Such as the `theta` of another class, or a name that is computed further."""
    assert mixed_angles(ast.parse(TURTLE.format(line))) == ()


@pytest.mark.parametrize(
    ("declared", "line", "told"),
    [
        ("unit='deg'", "wanted - pose.theta", PLAIN.format("self.wanted", "pose.theta")),
        ("unit='rad'", "math.radians(pose.theta)", "pose.theta is in radians already: leave out math.radians"),
        ("unit='rad'", "np.degrees(math.degrees(given))", "math.degrees(given) is in degrees already"),
    ],
)
def test_a_file_with_one_mention(declared: str, line: str, told: str) -> None:
    """A parameter in degrees is enough, and so is a conversion to radians."""
    source = f"""
from turtlesim.msg import Pose

class Turtle(Node):
    wanted = Param(90.0, {declared})

    def heard(self, given, pose: Pose):
        return {line.replace("wanted", "self.wanted")}
"""
    [(_, text)] = mixed_angles(ast.parse(source))
    assert text.startswith(told)


def test_another_pose() -> None:
    """It may be in degrees."""
    assert (
        mixed_angles(ast.parse(TURTLE.replace("graphflow.msgs.turtlesim.msg", "poses").format("angle - pose.theta")))
        == ()
    )


def test_a_callback_of_rclpy() -> None:
    """Its message is a pose, too."""
    source = TURTLE.replace('    @subscription(Pose, "pose")\n    async def', "    def").replace("graphflow.msgs.", "")
    made = "self.create_subscription(Pose, 'pose', self.heard, 10)\n        error = angle - self.pose.theta"
    assert mixed_angles(ast.parse(source.format("error = angle - self.pose.theta"))) == ()
    assert len(mixed_angles(ast.parse(source.format(made)))) == 1


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("x = math.radians(pose.theta)", "pose.theta is in radians already: leave out math.radians"),
        ("x = math.degrees(angle)", "angle is in degrees already: leave out math.degrees"),
        ("x = math.radians(angle)", ""),
        ("x = math.radians(given)", ""),
    ],
)
def test_angles_that_are_converted_twice(line: str, text: str) -> None:
    """Only where the unit is known."""
    assert [found for _, found in mixed_angles(ast.parse(TURTLE.format(line)))] == ([text] if text else [])
