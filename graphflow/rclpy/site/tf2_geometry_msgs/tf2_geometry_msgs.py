"""Transforms of geometry_msgs messages to another frame."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from geometry_msgs.msg import (
    Point32,
    PointStamped,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3,
    Vector3Stamped,
    WrenchStamped,
)
from tf2_py import poses
from tf2_py.core import pose_of
from tf2_ros.buffer_interface import ConvertRegistration, TransformRegistration

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


def to_msg_msg(msg: Any) -> Any:
    """Return the message unchanged."""
    return msg


def from_msg_msg(msg: Any) -> Any:
    """Return the message unchanged."""
    return msg


def _pose(transform: TransformStamped) -> poses.Pose:
    """Return the pose of a transform, with its rotation normalized."""
    found = pose_of(transform.transform)
    return found._replace(rotation=_unit(found.rotation))


def _unit(q: poses.Quaternion) -> poses.Quaternion:
    """Normalize a quaternion, with the sign that makes w >= 0; zero becomes the identity."""
    length = math.copysign(math.hypot(*q), q[3])
    return (q[0] / length, q[1] / length, q[2] / length, q[3] / length) if length else poses.IDENTITY.rotation


def _xyz(vector: Vector3) -> poses.Vector:
    return vector.x, vector.y, vector.z


def _set(vector: Vector3, values: poses.Vector) -> None:
    vector.x, vector.y, vector.z = values


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """Transform a point to the frame of the transform's header."""
    out = PointStamped(header=transform.header)
    _set(out.point, _pose(transform).point(_xyz(point.point)))
    return out


def do_transform_polygon_stamped(polygon: PolygonStamped, transform: TransformStamped) -> PolygonStamped:
    """Transform a polygon's points to the frame of the transform's header."""
    out, pose = PolygonStamped(header=transform.header), _pose(transform)
    for point in polygon.polygon.points:
        x, y, z = pose.point(_xyz(point))
        out.polygon.points.append(Point32(x=x, y=y, z=z))
    return out


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """Transform a vector, which is only rotated."""
    out = Vector3Stamped(header=transform.header)
    _set(out.vector, _rotated(vector3.vector, transform))
    return out


def _rotated(vector: Vector3, transform: TransformStamped) -> poses.Vector:
    return poses.rotate(_pose(transform).rotation, _xyz(vector))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """Transform a pose without a header."""
    q = pose.orientation
    moved = _pose(transform).of(poses.Pose(_xyz(pose.position), _unit((q.x, q.y, q.z, q.w))))
    out = Pose()
    _set(out.position, moved.translation)
    r = out.orientation
    r.x, r.y, r.z, r.w = _unit(moved.rotation)
    return out


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """Transform a pose to the frame of the transform's header."""
    return PoseStamped(header=transform.header, pose=do_transform_pose(pose.pose, transform))


def transform_covariance(cov_in: Any, transform: TransformStamped) -> Any:
    """Rotate the axes of a pose's covariance, 6 by 6 as 36 numbers; translation does not change it."""
    rotation = _pose(transform).rotation
    turn = np.array([poses.rotate(rotation, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]).T
    both = np.kron(np.eye(2), turn)
    return (both @ np.reshape(cov_in, (6, 6)) @ both.T).ravel()


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """Transform a pose and its covariance to the frame of the transform's header."""
    out = PoseWithCovarianceStamped(header=transform.header)
    out.pose.pose = do_transform_pose(pose.pose.pose, transform)
    out.pose.covariance = transform_covariance(pose.pose.covariance, transform)
    return out


def do_transform_wrench(wrench: WrenchStamped, transform: TransformStamped) -> WrenchStamped:
    """Transform a force and a torque, which are only rotated."""
    out = WrenchStamped(header=transform.header)
    _set(out.wrench.force, _rotated(wrench.wrench.force, transform))
    _set(out.wrench.torque, _rotated(wrench.wrench.torque, transform))
    return out


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
