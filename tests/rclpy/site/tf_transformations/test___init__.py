"""Rotations, by examples and by going there and back."""

from __future__ import annotations

import importlib
import math
import sys

import numpy as np
import pytest
import tf_transformations as tf
from hypothesis import given
from hypothesis import strategies as st

from tests.cases import slow

angles = st.floats(-1.5, 1.5)


@slow
@given(angles, angles, angles)
def test_roll_pitch_and_yaw_there_and_back(roll: float, pitch: float, yaw: float) -> None:
    """By quaternions, x first, and by matrices."""
    quaternion = tf.quaternion_from_euler(roll, pitch, yaw)
    assert tf.euler_from_quaternion(quaternion) == pytest.approx((roll, pitch, yaw), abs=1e-6)
    assert tf.euler_from_quaternion(list(quaternion)) == pytest.approx((roll, pitch, yaw), abs=1e-6)
    matrix = tf.euler_matrix(roll, pitch, yaw)
    assert tf.quaternion_matrix(quaternion) == pytest.approx(matrix, abs=1e-9)
    assert tf.euler_from_matrix(matrix) == pytest.approx((roll, pitch, yaw), abs=1e-6)
    assert abs(tf.quaternion_from_matrix(matrix) @ quaternion) == pytest.approx(1)
    back = tf.quaternion_multiply(tf.quaternion_inverse(quaternion), quaternion)
    assert back == pytest.approx([0, 0, 0, 1], abs=1e-9)
    assert tf.quaternion_conjugate(quaternion) == pytest.approx(tf.quaternion_inverse(quaternion))


def test_a_quarter_turn_to_the_left() -> None:
    """Is about z, which comes third; other orders of axes are known too."""
    left = [0, 0, math.sqrt(0.5), math.sqrt(0.5)]
    assert tf.quaternion_from_euler(0, 0, math.pi / 2) == pytest.approx(left)
    assert tf.quaternion_from_euler(math.pi / 2, 0, 0, "rzyx") == pytest.approx(left)
    assert tf.quaternion_about_axis(math.pi / 2, (0, 0, 1)) == pytest.approx(left)
    half = tf.quaternion_slerp([0, 0, 0, 1], left, 0.5)
    assert tf.euler_from_quaternion(half) == pytest.approx((0, 0, math.pi / 4))
    assert tf.quaternion_slerp(left, left, 0.5) == pytest.approx(left)


def test_matrices() -> None:
    """Put together, taken apart, turned back."""
    turn = tf.rotation_matrix(math.pi / 2, (0, 0, 1), point=(1, 0, 0))
    assert turn @ [2, 0, 0, 1] == pytest.approx([1, 1, 0, 1])
    angle, axis, point = tf.rotation_from_matrix(turn)
    assert tf.rotation_matrix(angle, axis, point) == pytest.approx(turn)
    moved = tf.concatenate_matrices(tf.translation_matrix((1, 2, 3)), turn)
    assert tf.translation_from_matrix(tf.translation_matrix((1, 2, 3))) == pytest.approx([1, 2, 3])
    assert tf.concatenate_matrices(tf.inverse_matrix(moved), moved) == pytest.approx(tf.identity_matrix(), abs=1e-12)
    assert tf.is_same_transform(moved, moved * 2)
    assert not tf.is_same_transform(moved, turn)
    assert tf.scale_matrix(2, (1, 0, 0)) @ [2, 1, 0, 1] == pytest.approx([3, 2, 0, 1])
    parts = ([1.0, 2.0, 3.0], [0.1, 0.2, 0.3], (0.1, 0.2, 0.3), [4.0, 5.0, 6.0])
    scale, shear, turned, translate, perspective = tf.decompose_matrix(tf.compose_matrix(*parts))
    for found, expected in zip((scale, shear, turned, translate), parts, strict=True):
        assert found == pytest.approx(expected)
    assert perspective == pytest.approx([0, 0, 0, 1])
    with pytest.raises(ValueError, match="not a rotation"):
        tf.rotation_from_matrix(tf.scale_matrix(2))


def test_vectors() -> None:
    """Their length, and with length 1."""
    assert tf.vector_norm([3, 4]) == 5
    assert tf.unit_vector([3, 4]) == pytest.approx([0.6, 0.8])
    assert tf.unit_vector([[3, 4], [0, 2]], axis=1) == pytest.approx(np.array([[0.6, 0.8], [0, 1]]))
    assert tf.vector_norm(tf.random_quaternion()) == pytest.approx(1)


def test_without_the_library_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    """transforms3d is no dependency: only programs that import this package need it."""
    monkeypatch.setitem(sys.modules, "transforms3d", None)
    with pytest.raises(ModuleNotFoundError, match="tf_transformations needs transforms3d: pip install transforms3d"):
        importlib.reload(tf)
