"""Angles in the parts of a quaternion."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.units.quaternions import angles_as_quaternions


@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("goal.pose.orientation.z = 1.5708", "write math.sin(1.5708 / 2), and math.cos(1.5708 / 2) into w"),
        ("goal.pose.orientation.z = -1.57", "goal.pose.orientation.z is a part of a quaternion, not an angle"),
        ("goal.pose.orientation.z = 90.0", "write math.sin(math.radians(90.0) / 2), and math.cos(math.radians(90.0) /"),
        ("t.transform.rotation.z = self.yaw", "write math.sin(self.yaw / 2)"),
        ("t.transform.rotation.z = math.pi / 2", "write math.sin((math.pi / 2) / 2)"),
        ("p.orientation.z = math.radians(90)", "write math.sin(math.radians(90) / 2)"),
        ("p.orientation.w = goal_yaw", "it is math.cos(angle / 2)"),
        ("p.orientation = Quaternion(z=theta)", "z is a part of a quaternion"),
        ("Transform.of('a', 'b', rotation=(1.0, 0.0, 0.0, 0.0))", "no turn is (0.0, 0.0, 0.0, 1.0)"),
        ("yaw = m.pose.orientation.z", "write 2 * math.atan2(m.pose.orientation.z, m.pose.orientation.w)"),
        ("self.current_yaw = t.rotation.w", "write 2 * math.atan2(t.rotation.z, t.rotation.w)"),
    ],
)
def test_angles(code: str, told: str) -> None:
    """The sentence has the formula."""
    [(_, text)] = angles_as_quaternions(ast.parse(code))
    assert told in text


@pytest.mark.parametrize(
    "code",
    [
        *("p.orientation.z = math.sin(yaw / 2)", "p.orientation.z = q[2]", "p.orientation.w = 1.0"),
        *("p.orientation.z = -0.707", "p.orientation.z = q.z", "p.position.z = 1.57", "p.orientation.z = sin_yaw"),
        *("Quaternion(z=sin(yaw / 2), w=cos(yaw / 2))", "p.orientation.z = z", "p.angular.z = yaw"),
        "Transform.of('a', 'b', rotation=(0.0, 0.0, 0.0, 1.0))",
        *("z = p.orientation.z", "yaw = p.orientation.z * 2", "yaw = euler.z"),
        *("p.orientation.z = math.sin(math.radians(90) / 2)", "p.orientation.z = to_quaternion(yaw).z"),
    ],
)
def test_parts(code: str) -> None:
    """A sine, a part of another quaternion and a number up to 1 are left alone."""
    assert list(angles_as_quaternions(ast.parse(code))) == []
