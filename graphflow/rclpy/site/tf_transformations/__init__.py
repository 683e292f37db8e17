"""Rotations as quaternions (x, y, z, w), Euler angles and matrices, computed by the library transforms3d.

As in ROS 2, users of this package install transforms3d themselves: nothing else needs it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

try:
    from transforms3d import affines, euler, quaternions
except ModuleNotFoundError as error:
    from graphflow.rclpy.hints import tracebacks

    tracebacks.install()  # its frames are the program's alone
    raise ModuleNotFoundError(
        "tf_transformations needs transforms3d: pip install transforms3d", name=error.name
    ) from None

Array = NDArray[np.float64]

__all__ = [
    "compose_matrix",
    "concatenate_matrices",
    "decompose_matrix",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "rotation_from_matrix",
    "rotation_matrix",
    "scale_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]


def _w_first(quaternion: ArrayLike) -> Array:
    return np.roll(np.asarray(quaternion, dtype=float), 1)


def _w_last(quaternion: ArrayLike) -> Array:
    return np.roll(np.asarray(quaternion, dtype=float), -1)


def _affine(rotation: ArrayLike, translation: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = rotation, translation
    return out


def identity_matrix() -> Array:
    """Return the identity, 4 by 4."""
    return np.eye(4)


def translation_matrix(direction: ArrayLike) -> Array:
    """Return a translation, 4 by 4."""
    return _affine(np.eye(3), np.asarray(direction)[:3])


def translation_from_matrix(matrix: ArrayLike) -> Array:
    """Return the translation of a 4 by 4 matrix."""
    return np.array(matrix, dtype=float)[:3, 3]


def rotation_matrix(angle: float, direction: ArrayLike, point: ArrayLike | None = None) -> Array:
    """Return a rotation of `angle` radians about an axis, through a point or the origin, 4 by 4."""
    turn = quaternions.quat2mat(quaternions.axangle2quat(np.asarray(direction)[:3], angle))
    if point is None:
        return _affine(turn)
    fixed = np.asarray(point, dtype=float)[:3]
    return _affine(turn, fixed - turn @ fixed)


def rotation_from_matrix(matrix: ArrayLike) -> tuple[float, Array, Array]:
    """Return a rotation's angle in radians, its axis, and a point on the axis.

    Raises:
        ValueError: The matrix is not a pure rotation.
    """
    whole = np.asarray(matrix, dtype=float)
    axis, angle = quaternions.quat2axangle(quaternions.mat2quat(whole[:3, :3]))
    if not np.allclose(whole[:3, :3] @ whole[:3, :3].T, np.eye(3), atol=1e-8):
        raise ValueError("the matrix is not a rotation")
    point = np.linalg.lstsq(np.eye(3) - whole[:3, :3], whole[:3, 3], rcond=None)[0]
    return float(angle), np.asarray(axis), np.append(point, 1.0)


def scale_matrix(factor: float, origin: ArrayLike | None = None) -> Array:
    """Return a matrix that scales, about a point or the origin, 4 by 4."""
    fixed = np.zeros(3) if origin is None else np.asarray(origin, dtype=float)[:3]
    return _affine(np.eye(3) * factor, fixed * (1 - factor))


def concatenate_matrices(*matrices: ArrayLike) -> Array:
    """Return the product of matrices."""
    out = np.eye(4)
    for matrix in matrices:
        out = out @ np.asarray(matrix, dtype=float)
    return out


def inverse_matrix(matrix: ArrayLike) -> Array:
    """Return the inverse of a matrix. Raises numpy.linalg.LinAlgError if there is none."""
    return np.linalg.inv(np.asarray(matrix, dtype=float))


def is_same_transform(matrix0: ArrayLike, matrix1: ArrayLike) -> bool:
    """Whether two matrices are the same transform of homogeneous coordinates."""
    one, other = np.array(matrix0, dtype=float), np.array(matrix1, dtype=float)
    return bool(np.allclose(one / one[3, 3], other / other[3, 3]))


def compose_matrix(
    scale: ArrayLike | None = None,
    shear: ArrayLike | None = None,
    angles: ArrayLike | None = None,
    translate: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
) -> Array:
    """Return the 4 by 4 matrix of scale, shear, Euler angles about x, y and z, translation and perspective."""
    turn = np.eye(3) if angles is None else euler.euler2mat(*np.asarray(angles, dtype=float), "sxyz")
    out: Array = affines.compose(
        np.zeros(3) if translate is None else np.asarray(translate, dtype=float)[:3],
        turn,
        np.ones(3) if scale is None else np.asarray(scale, dtype=float)[:3],
        None if shear is None else np.asarray(shear, dtype=float)[:3],
    )
    if perspective is None:
        return out
    projected = np.eye(4)
    projected[3] = perspective
    return projected @ out


def decompose_matrix(matrix: ArrayLike) -> tuple[Array, Array, tuple[float, float, float], Array, Array]:
    """Return a matrix's scale, shear, Euler angles about x, y, z, translation and perspective. Raises ValueError."""
    whole = np.array(matrix, dtype=float)
    perspective = whole[3].copy()
    whole[3] = 0.0, 0.0, 0.0, 1.0
    translate, turn, scale, shear = affines.decompose44(whole)
    return scale, shear, euler.mat2euler(turn, "sxyz"), translate, perspective


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """Return a rotation by three angles in radians, 4 by 4."""
    return _affine(euler.euler2mat(ai, aj, ak, axes))


def euler_from_matrix(matrix: ArrayLike, axes: str = "sxyz") -> tuple[float, float, float]:
    """Return the three angles of a rotation, in radians."""
    ai, aj, ak = euler.mat2euler(np.asarray(matrix, dtype=float)[:3, :3], axes)
    return ai, aj, ak


def euler_from_quaternion(quaternion: ArrayLike, axes: str = "sxyz") -> tuple[float, float, float]:
    """Return the three angles of a rotation in radians, by default roll, pitch and yaw."""
    ai, aj, ak = euler.quat2euler(_w_first(quaternion), axes)
    return ai, aj, ak


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """Return the rotation by three angles in radians, by default roll, pitch and yaw."""
    return _w_last(euler.euler2quat(ai, aj, ak, axes))


def quaternion_about_axis(angle: float, axis: ArrayLike) -> Array:
    """Return the rotation of `angle` radians about an axis."""
    return _w_last(quaternions.axangle2quat(np.asarray(axis)[:3], angle))


def quaternion_matrix(quaternion: ArrayLike) -> Array:
    """Return a rotation, 4 by 4."""
    return _affine(quaternions.quat2mat(_w_first(quaternion)))


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Return the rotation of a matrix."""
    return _w_last(quaternions.mat2quat(np.asarray(matrix, dtype=float)[:3, :3]))


def quaternion_multiply(quaternion1: ArrayLike, quaternion0: ArrayLike) -> Array:
    """Return the rotation `quaternion0` followed by `quaternion1`."""
    return _w_last(quaternions.qmult(_w_first(quaternion1), _w_first(quaternion0)))


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """Return the inverse rotation, for a quaternion of length 1."""
    return _w_last(quaternions.qconjugate(_w_first(quaternion)))


def quaternion_inverse(quaternion: ArrayLike) -> Array:
    """Return the inverse rotation."""
    return _w_last(quaternions.qinverse(_w_first(quaternion)))


def quaternion_slerp(
    quat0: ArrayLike, quat1: ArrayLike, fraction: float, spin: int = 0, shortestpath: bool = True
) -> Array:
    """Interpolate a rotation at a share of 0 to 1.

    Args:
        spin: The number of additional full turns.
        shortestpath: Whether to take the shorter path.
    """
    start, end = unit_vector(quat0), unit_vector(quat1)
    dot = float(start @ end)
    if shortestpath and dot < 0:
        dot, end = -dot, -end
    angle = float(np.arccos(np.clip(dot, -1.0, 1.0))) + spin * np.pi
    if abs(np.sin(angle)) < 1e-12:
        return start if fraction < 1 else end
    out: Array = (np.sin((1 - fraction) * angle) * start + np.sin(fraction * angle) * end) / np.sin(angle)
    return out


def random_quaternion(rand: Sequence[float] | None = None) -> Array:
    """Return a uniformly random rotation; `rand` are three numbers of 0 to 1."""
    a, b, c = np.random.default_rng().random(3) if rand is None else rand
    one, other = np.sqrt(1 - a), np.sqrt(a)
    x, y = np.sin(2 * np.pi * b) * one, np.cos(2 * np.pi * b) * one
    return np.array([x, y, np.sin(2 * np.pi * c) * other, np.cos(2 * np.pi * c) * other])


def unit_vector(data: ArrayLike, axis: int | None = None) -> Array:
    """Normalize a vector, or vectors along an axis."""
    values = np.asarray(data, dtype=float)
    out: Array = values / np.linalg.norm(values, axis=axis, keepdims=axis is not None)
    return out


def vector_norm(data: ArrayLike, axis: int | None = None) -> Any:
    """Return the length of a vector, or of vectors along an axis."""
    return np.linalg.norm(np.asarray(data, dtype=float), axis=axis)
