"""Poses of one frame in another: a rotation, then a translation, as plain floats, which suit such short vectors."""

from __future__ import annotations

import math
from math import acos, sin, sqrt
from typing import NamedTuple, TypeAlias

Vector: TypeAlias = tuple[float, float, float]
"""x, y, z in metres."""
Quaternion: TypeAlias = tuple[float, float, float, float]
"""x, y, z, w; of length 1."""


_new = tuple.__new__


class Pose(NamedTuple):
    """A frame's pose in its parent, which also converts coordinates in the frame to the parent's."""

    translation: Vector
    rotation: Quaternion

    def of(self, inner: Pose) -> Pose:
        """Return the pose in this one's parent of something with the pose `inner` in this one."""
        # `point` and `multiply` in one: lookups spend most of their time here.
        (tx, ty, tz), (x, y, z, w) = self
        (a, b, c), (bx, by, bz, bw) = inner
        u, v, t = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
        return _new(
            Pose,
            (
                (a + w * u + y * t - z * v + tx, b + w * v + z * u - x * t + ty, c + w * t + x * v - y * u + tz),
                (
                    w * bx + x * bw + y * bz - z * by,
                    w * by - x * bz + y * bw + z * bx,
                    w * bz + x * by - y * bx + z * bw,
                    w * bw - x * bx - y * by - z * bz,
                ),
            ),
        )

    def point(self, point: Vector) -> Vector:
        """Convert a point's coordinates to the parent's."""
        x, y, z = rotate(self.rotation, point)
        return x + self.translation[0], y + self.translation[1], z + self.translation[2]

    def inverse(self) -> Pose:
        """Return the parent's pose in the frame."""
        back = conjugate(self.rotation)
        x, y, z = rotate(back, self.translation)
        return Pose((-x, -y, -z), back)

    def towards(self, other: Pose, share: float) -> Pose:
        """Interpolate towards another pose, at a share of 0 to 1: linearly, with an even rotation."""
        (x, y, z), (u, v, w) = self.translation, other.translation
        moved = (x + (u - x) * share, y + (v - y) * share, z + (w - z) * share)
        return Pose(moved, slerp(self.rotation, other.rotation, share))


AXES: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""The axes x, y and z."""
IDENTITY = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation `b` followed by `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def unit(q: Quaternion) -> Quaternion:
    """Normalize a quaternion, with the sign that makes w >= 0; zero becomes the identity."""
    length = math.copysign(math.hypot(*q), q[3])
    return (q[0] / length, q[1] / length, q[2] / length, q[3] / length) if length else IDENTITY.rotation


def conjugate(q: Quaternion) -> Quaternion:
    """Return the inverse rotation."""
    return -q[0], -q[1], -q[2], q[3]


def rotate(q: Quaternion, vector: Vector) -> Vector:
    """Rotate a vector."""
    x, y, z, w = q
    a, b, c = vector
    u, v, t = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return a + w * u + y * t - z * v, b + w * v + z * u - x * t, c + w * t + x * v - y * u


def slerp(a: Quaternion, b: Quaternion, share: float) -> Quaternion:
    """Interpolate the shorter rotation from `a` to `b` at a share of 0 to 1."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    dot = ax * bx + ay * by + az * bz + aw * bw
    end = share
    if dot < 0:  # -b is the same rotation, on the nearer side
        dot, end = -dot, -share
    start = 1 - share
    if dot < 0.9999999:  # below that the chord serves: the sines would be nearly 0
        angle = acos(dot)
        start, end = sin(start * angle), sin(end * angle)
    x, y, z, w = start * ax + end * bx, start * ay + end * by, start * az + end * bz, start * aw + end * bw
    length = sqrt(x * x + y * y + z * z + w * w)
    return x / length, y / length, z / length, w / length


def about(axis: Vector, angle: float) -> Quaternion:
    """Return the rotation of `angle` radians about an axis of length 1."""
    sine = math.sin(angle / 2)
    return axis[0] * sine, axis[1] * sine, axis[2] * sine, math.cos(angle / 2)


def from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the rotation about the fixed axes x, y and z in turn, by angles in radians."""
    about_x, about_y = about((1.0, 0.0, 0.0), roll), about((0.0, 1.0, 0.0), pitch)
    return multiply(about((0.0, 0.0, 1.0), yaw), multiply(about_y, about_x))


def to_rpy(q: Quaternion) -> Vector:
    """Return the angles in radians that `from_rpy` takes; in gimbal lock, those without yaw."""
    (xx, yx, zx), (_, yy, zy), (_, yz, zz) = (rotate(q, axis) for axis in AXES)
    level = math.hypot(xx, yx)
    if level < 1e-9:
        return math.atan2(-yz, yy), math.atan2(-zx, level), 0.0
    return math.atan2(zy, zz), math.atan2(-zx, level), math.atan2(yx, xx)
