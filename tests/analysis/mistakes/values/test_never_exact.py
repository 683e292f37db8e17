"""Comparisons of measured places with `==`."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.never_exact import never_exact

POSES = """
from graphflow.msgs.turtlesim.msg import Pose

class Robot(Node):
    goal = Param(8.0)
    there = 2.5
    last = None

    @subscription(Pose, "pose")
    def heard(self, pose):
        {}
        self.last = pose.x
"""


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (
            "if pose.x == self.goal: pass",
            "pose.x is hardly ever exactly self.goal; write abs(pose.x - self.goal) < 0.1",
        ),
        (
            "if self.there != pose.y: pass",
            "pose.y is hardly ever exactly self.there; write abs(pose.y - self.there) > 0.1",
        ),
        ("if pose.theta == 1.57: pass", "pose.theta is hardly ever exactly 1.57; write abs(pose.theta - 1.57) < 0.1"),
    ],
)
def test_a_place_is_never_exact(line: str, told: str) -> None:
    """A pose's place is told if `==` or `!=` compares it with a number or a parameter."""
    assert [text for _, text in never_exact(ast.parse(POSES.format(line)))] == [f"{told}, with a tolerance"]


@pytest.mark.parametrize(
    "line",
    [
        "if pose.x == 0.0: pass",
        "if pose.x == self.last: pass",
        "if pose.linear_velocity == 1.0: pass",
        "if pose.x > self.goal: pass",
        "if abs(pose.x - self.goal) < 0.1: pass",
        "if other.x == 8.0: pass",
        "assert pose.x == 8.0",
        "def test_place(pose: Pose):\n            return pose.x == 8.0",
        "self.teleport(8.0)\n        if pose.x == 8.0: pass",
    ],
)
def test_places_that_may_be_exact(line: str) -> None:
    """Zero, an earlier pose, a velocity as commanded, a test, and a turtle that is teleported are not told."""
    assert never_exact(ast.parse(POSES.format(line))) == ()
