"""Faults of single transforms, which keep them out of a buffer."""

from __future__ import annotations

import math

from graphflow.tf.poses import Pose

NAME_BOUND = 1000
"""The length of a frame's name in characters, at most."""
TOLERANCE = 0.01
"""The greatest deviation of a quaternion's squared length from 1."""


def fault_of(frame: str, parent: str, pose: Pose) -> str | None:
    """Describe the fault of a transform; None if it has none."""
    if not frame or not parent:
        return "frame_id and child_frame_id must not be empty"
    if frame == parent:
        return f"frame_id and child_frame_id are both {frame[:NAME_BOUND]!r}"
    if max(len(frame), len(parent)) > NAME_BOUND:
        return f"the name of a frame is longer than {NAME_BOUND} characters"
    if not (frame.isprintable() and parent.isprintable()):
        return f"the name of a frame has control characters: {frame!r} in {parent!r}"
    if not all(map(math.isfinite, (*pose.translation, *pose.rotation))):
        return f"a number of {frame!r} is infinite or not a number"
    x, y, z, w = pose.rotation
    if abs(x * x + y * y + z * z + w * w - 1) > TOLERANCE:
        return f"the quaternion of {frame!r} is not normalized"
    return None
