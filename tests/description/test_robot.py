"""Robots; what is read of their files is in test_urdf.py."""

from __future__ import annotations

from graphflow.description.robot import Joint, Robot
from graphflow.tf.poses import IDENTITY


def test_the_root() -> None:
    """It is the link that is no joint's child; a joint without limits starts at 0."""
    made = Joint("j", "continuous", "a", "b", IDENTITY, (1.0, 0.0, 0.0), None, None)
    robot = Robot("r", {"b": None, "a": None}, {"j": made})  # type: ignore[dict-item]
    assert robot.root == "a"
    assert made.home == 0.0
    assert made.moves
