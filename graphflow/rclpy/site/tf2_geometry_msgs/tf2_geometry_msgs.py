"""Transforms of geometry_msgs messages to another frame."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
    WrenchStamped,
)
from numpy.typing import ArrayLike, NDArray
from tf2_ros.buffer_interface import ConvertRegistration, TransformRegistration

from graphflow.tf import messages, poses
from graphflow.tf.transform import pose_of

M = TypeVar("M")

__all__ = [
    "PointStamped",
    "PolygonStamped",
    "PoseStamped",
    "PoseWithCovarianceStamped",
    "Vector3Stamped",
    "WrenchStamped",
    "do_transform_point",
    "do_transform_polygon_stamped",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_pose_with_covariance_stamped",
    "do_transform_vector3",
    "do_transform_wrench",
    "from_msg_msg",
    "to_msg_msg",
    "transform_covariance",
]


def to_msg_msg(msg: M) -> M:
    """Return the message unchanged."""
    return msg


def from_msg_msg(msg: M) -> M:
    """Return the message unchanged."""
    return msg


def _pose(transform: TransformStamped) -> poses.Pose:
    """Return the pose of a transform, with its rotation normalized, since programs make transforms by hand."""
    found = pose_of(transform.transform)
    return found._replace(rotation=poses.unit(found.rotation))


def _converted(message: M, transform: TransformStamped) -> M:
    out: M = messages.convert(message, _pose(transform), transform.header)
    return out


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """Transform a point to the frame of the transform's header."""
    return _converted(point, transform)


def do_transform_polygon_stamped(polygon: PolygonStamped, transform: TransformStamped) -> PolygonStamped:
    """Transform a polygon's points to the frame of the transform's header."""
    return _converted(polygon, transform)


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """Transform a vector, which is only rotated."""
    return _converted(vector3, transform)


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """Transform a pose without a header."""
    return messages.moved(pose, _pose(transform))


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """Transform a pose to the frame of the transform's header."""
    return _converted(pose, transform)


def transform_covariance(cov_in: ArrayLike, transform: TransformStamped) -> NDArray[np.float64]:
    """Rotate the axes of a pose's covariance, 6 by 6 as 36 numbers; translation does not change it."""
    return messages.turned_covariance(cov_in, _pose(transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """Transform a pose and its covariance to the frame of the transform's header."""
    return _converted(pose, transform)


def do_transform_wrench(wrench: WrenchStamped, transform: TransformStamped) -> WrenchStamped:
    """Transform a force and a torque, which are only rotated."""
    return _converted(wrench, transform)


def _register() -> None:
    transforms, conversions = TransformRegistration(), ConvertRegistration()
    known = {
        PointStamped: do_transform_point,
        PolygonStamped: do_transform_polygon_stamped,
        Vector3Stamped: do_transform_vector3,
        PoseStamped: do_transform_pose_stamped,
        PoseWithCovarianceStamped: do_transform_pose_with_covariance_stamped,
        WrenchStamped: do_transform_wrench,
    }
    for kind, do in known.items():
        transforms.add(kind, do)
        conversions.add_to_msg(kind, to_msg_msg)
        conversions.add_from_msg(kind, from_msg_msg)


_register()
