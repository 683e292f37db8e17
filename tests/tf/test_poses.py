"""Poses, by examples that can be seen with the mind's eye and by transforms3d's arithmetic."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from transforms3d import euler, quaternions

from graphflow.tf.poses import IDENTITY, Pose, from_rpy, multiply, rotate, slerp, to_rpy
from tests.cases import slow

LEFT = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
"""A quarter turn to the left."""
numbers = st.floats(-10, 10)
vectors = st.tuples(numbers, numbers, numbers)
angles = st.floats(-1.5, 1.5)
rotations = (
    st.tuples(numbers, numbers, numbers, numbers)
    .filter(lambda q: sum(n * n for n in q) > 0.1)
    .map(lambda q: tuple(n / math.sqrt(sum(m * m for m in q)) for n in q))
)
poses = st.builds(Pose, vectors, rotations)


def test_a_frame_that_is_moved_and_turned() -> None:
    """One metre ahead and turned to the left, what was ahead of it is to the left of where it came from."""
    moved = Pose((1.0, 0.0, 0.0), LEFT)
    assert moved.point((2.0, 0.0, 0.0)) == pytest.approx((1.0, 2.0, 0.0))
    assert moved.of(moved).translation == pytest.approx((1.0, 1.0, 0.0))
    assert moved.inverse().translation == pytest.approx((0.0, 1.0, 0.0))


@slow
@given(poses, poses, vectors)
def test_poses_compose_and_go_back(a: Pose, b: Pose, point: tuple[float, float, float]) -> None:
    """As maps of points do."""
    assert a.of(b).point(point) == pytest.approx(a.point(b.point(point)), abs=1e-9)
    assert a.inverse().point(a.point(point)) == pytest.approx(point, abs=1e-9)


@slow
@given(rotations, rotations, vectors)
def test_rotations_are_those_of_the_library(a: tuple[float, ...], b: tuple[float, ...], v: tuple[float, ...]) -> None:
    """Which has w first."""
    one, other = np.roll(a, 1), np.roll(b, 1)
    assert np.roll(multiply(a, b), 1) == pytest.approx(quaternions.qmult(one, other), abs=1e-9)  # type: ignore[arg-type]
    assert rotate(a, v) == pytest.approx(quaternions.rotate_vector(v, one), abs=1e-9)  # type: ignore[arg-type]


@slow
@given(angles, angles, angles)
def test_roll_pitch_and_yaw_are_those_of_the_library(roll: float, pitch: float, yaw: float) -> None:
    """There as its `sxyz`, and back."""
    found = from_rpy(roll, pitch, yaw)
    assert np.roll(found, 1) == pytest.approx(euler.euler2quat(roll, pitch, yaw, "sxyz"), abs=1e-9)
    assert to_rpy(found) == pytest.approx((roll, pitch, yaw), abs=1e-6)


@pytest.mark.parametrize("pitch", [math.pi / 2, -math.pi / 2])
def test_straight_up_or_down_there_is_no_yaw(pitch: float) -> None:
    """Only the sum, or the difference, of roll and yaw can be told there."""
    one = from_rpy(0.3, pitch, 0.2)
    roll, same, yaw = to_rpy(one)
    assert (same, yaw) == pytest.approx((pitch, 0.0))
    assert abs(np.dot(from_rpy(roll, same, yaw), one)) == pytest.approx(1.0)


def test_between_two_poses_it_turns_evenly_the_shorter_way() -> None:
    """Also where one quaternion is the negative of what it could be."""
    third = math.radians(15)
    other = (-LEFT[0], -LEFT[1], -LEFT[2], -LEFT[3])
    for end in (LEFT, other):
        assert slerp(IDENTITY.rotation, end, 1 / 3) == pytest.approx((0, 0, math.sin(third), math.cos(third)))
    assert slerp(LEFT, LEFT, 0.5) == pytest.approx(LEFT)
    half = IDENTITY.towards(Pose((2.0, 4.0, -6.0), LEFT), 0.5)
    assert half.translation == (1.0, 2.0, -3.0)
