"""Poses in the plane, for robots that drive on a floor."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pose2D:
    """A pose in the plane: x and y in metres, yaw in radians."""

    x: float
    y: float
    yaw: float

    def of(self, inner: Pose2D) -> Pose2D:
        """Return the pose in this one's frame's parent of something with the pose `inner` in this one."""
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2D(
            self.x + cosine * inner.x - sine * inner.y,
            self.y + sine * inner.x + cosine * inner.y,
            math.remainder(self.yaw + inner.yaw, math.tau),
        )

    def inverse(self) -> Pose2D:
        """Return the pose of the parent in this frame."""
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2D(-cosine * self.x - sine * self.y, sine * self.x - cosine * self.y, -self.yaw)
