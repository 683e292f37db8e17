"""Names of a file that stand for turtlesim poses and functions of `math`."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.pose_names import pose_names
from graphflow.analysis.syntax import walk

SOURCE = """\
from math import atan2, cos as cosine
from turtlesim.msg import Color, Pose

class Robot:
    def heard(self, pose: Pose, color: Color, other):
        self.last = pose
        {}
"""


def _is_pose(line: str) -> bool:
    module = ast.parse(SOURCE.format(line))
    names = pose_names(module)
    [found] = [names.is_pose(n.value, parents) for n, parents in walk(module) if isinstance(n, ast.Expr)]
    return found


@pytest.mark.parametrize("line", ["pose", "self.last"])
def test_a_pose(line: str) -> None:
    """An annotated argument is one, and so is the attribute that keeps it."""
    assert _is_pose(line)


@pytest.mark.parametrize(
    "line",
    [
        *("color", "other", "self.next", "pose.x"),
        "x = self.create_subscription(Color, 'color', self.heard, 10)\n        other",
        "self.next = self.before\n        self.before = self.next\n        self.next",
    ],
)
def test_other_names(line: str) -> None:
    """Arguments of other types, attributes that nothing sets, or each other alone, and a pose's fields are none."""
    assert not _is_pose(line)


def test_a_file_that_sets_theta() -> None:
    """It may keep degrees there, so that its poses are not followed."""
    assert not pose_names(ast.parse(SOURCE.format("other.theta = 90.0"))).poses


def test_functions_of_math() -> None:
    """They are known by an import or by their module, and by nothing else."""
    names = pose_names(ast.parse(SOURCE.format("...")))
    called = [
        names.called(ast.parse(text, mode="eval").body)
        for text in ("atan2", "math.sin", "np.cos", "sin", "a.sin", "cos")
    ]
    assert called == ["atan2", "sin", "cos", "", "", ""]
