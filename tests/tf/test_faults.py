"""Transforms that are refused."""

from __future__ import annotations

import math

import pytest

from graphflow.tf.faults import NAME_BOUND, fault_of
from graphflow.tf.poses import IDENTITY, Pose


@pytest.mark.parametrize(
    ("frame", "parent", "pose", "text"),
    [
        ("base", "", IDENTITY, "must not be empty"),
        ("base", "base", IDENTITY, "frame_id and child_frame_id are both 'base'"),
        ("b" * (NAME_BOUND + 1), "odom", IDENTITY, "longer than 1000 characters"),
        ("base\x1b[2J", "odom", IDENTITY, r"has control characters: 'base\x1b[2J' in 'odom'"),
        (
            "base",
            "odom",
            Pose((math.inf, 0.0, 0.0), IDENTITY.rotation),
            "a number of 'base' is infinite or not a number",
        ),
        ("base", "odom", Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.2)), "the quaternion of 'base' is not normalized"),
    ],
)
def test_faults(frame: str, parent: str, pose: Pose, text: str) -> None:
    """Each is described, with the frame."""
    assert text in (fault_of(frame, parent, pose) or "")


def test_no_fault() -> None:
    """Names may have any printable characters, and rotations may be slightly off."""
    assert fault_of("böse/base_link", "odom", Pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.001, 1.001))) is None
