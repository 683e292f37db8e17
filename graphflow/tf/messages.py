"""Conversion of messages with a header to another frame: points, poses, wrenches, scans and clouds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from graphflow.msgs.geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    TwistStamped,
    Vector3,
    Vector3Stamped,
    WrenchStamped,
)
from graphflow.msgs.geometry_msgs.msg import Pose as PoseMessage
from graphflow.msgs.sensor_msgs.msg import LaserScan, PointCloud2, PointField
from graphflow.msgs.std_msgs.msg import Header
from graphflow.tf.poses import AXES, Pose, Vector, rotate, unit

Conversion: TypeAlias = Callable[[Any, Pose, Header], Any]
"""Returns a message, converted by the pose of its frame in that of the header."""


def convert(message: object, pose: Pose, header: Header) -> Any:
    """Return a message of another frame in the frame of the header.

    Args:
        pose: The pose of the message's frame in the header's.

    Raises:
        TypeError: Messages of its type cannot be converted.
    """
    conversion = CONVERSIONS.get(type(message).__name__)
    if conversion is None:
        known = ", ".join(CONVERSIONS)
        raise TypeError(f"a {type(message).__name__} cannot be transformed; these can: {known}, and arrays by points()")
    return conversion(message, pose, header)


def xyz(vector: Any) -> Vector:
    """Return the fields of a vector or point."""
    return vector.x, vector.y, vector.z


def set_xyz(vector: Any, values: Vector) -> None:
    """Set the fields of a vector or point."""
    vector.x, vector.y, vector.z = values


def _point(message: PointStamped, pose: Pose, header: Header) -> PointStamped:
    out = type(message)(header=header)
    set_xyz(out.point, pose.point(xyz(message.point)))
    return out


def _vector(message: Vector3Stamped, pose: Pose, header: Header) -> Vector3Stamped:
    """Rotate a vector, which has no place."""
    out = type(message)(header=header)
    _turn(message.vector, pose, out.vector)
    return out


def _turn(vector: Vector3, pose: Pose, out: Vector3) -> None:
    set_xyz(out, rotate(pose.rotation, xyz(vector)))


def _polygon(message: PolygonStamped, pose: Pose, header: Header) -> PolygonStamped:
    out = type(message)(header=header)
    for point in message.polygon.points:
        x, y, z = pose.point(xyz(point))
        out.polygon.points.append(type(point)(x=x, y=y, z=z))
    return out


def moved(message: PoseMessage, pose: Pose) -> PoseMessage:
    """Convert a pose without a header; a quaternion of length 0 counts as no rotation."""
    q, out = message.orientation, type(message)()
    found = pose.of(Pose(xyz(message.position), unit((q.x, q.y, q.z, q.w))))
    set_xyz(out.position, found.translation)
    turn = out.orientation
    turn.x, turn.y, turn.z, turn.w = unit(found.rotation)
    return out


def _pose(message: PoseStamped, pose: Pose, header: Header) -> PoseStamped:
    return type(message)(header=header, pose=moved(message.pose, pose))


def _pose_with_covariance(message: PoseWithCovarianceStamped, pose: Pose, header: Header) -> PoseWithCovarianceStamped:
    out = type(message)(header=header)
    out.pose.pose = moved(message.pose.pose, pose)
    out.pose.covariance = turned_covariance(message.pose.covariance, pose)
    return out


def turned_covariance(covariance: Any, pose: Pose) -> NDArray[np.float64]:
    """Rotate the axes of a pose's covariance, 6 by 6 as 36 numbers; translation does not change it."""
    both = np.kron(np.eye(2), rotation_matrix(pose))
    return np.asarray((both @ np.reshape(covariance, (6, 6)) @ both.T).ravel())


def rotation_matrix(pose: Pose) -> NDArray[np.float64]:
    """Return the matrix of a pose's rotation, of shape (3, 3)."""
    return np.array([rotate(pose.rotation, axis) for axis in AXES]).T


def _wrench(message: WrenchStamped, pose: Pose, header: Header) -> WrenchStamped:
    out = type(message)(header=header)
    _turn(message.wrench.force, pose, out.wrench.force)
    _turn(message.wrench.torque, pose, out.wrench.torque)
    return out


def _twist(message: TwistStamped, pose: Pose, header: Header) -> TwistStamped:
    """Rotate a twist's two vectors; the velocity stays that of the same point."""
    out = type(message)(header=header)
    _turn(message.twist.linear, pose, out.twist.linear)
    _turn(message.twist.angular, pose, out.twist.angular)
    return out


def scan_points(scan: LaserScan) -> NDArray[np.float64]:
    """Return the points of a scan in its own frame, of shape (n, 3); beams outside its range limits have none."""
    ranges = np.asarray(scan.ranges, dtype=np.float64)
    # Beams without an echo are left out first: infinity times the sine of 0 is no number.
    valid = np.flatnonzero(_is_valid(scan, ranges))
    ranges, angles = ranges[valid], scan.angle_min + scan.angle_increment * valid
    return np.stack([ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))], axis=1)


def _is_valid(scan: LaserScan, ranges: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)


def _scan(message: LaserScan, pose: Pose, header: Header) -> PointCloud2:
    """Convert a scan to a cloud with the fields x, y, z and, where the scan has them, intensity."""
    points = scan_points(message) @ rotation_matrix(pose).T + pose.translation
    columns = [points]
    names = ["x", "y", "z"]
    if len(message.intensities) == len(message.ranges):
        valid = _is_valid(message, np.asarray(message.ranges, dtype=np.float64))
        columns.append(np.asarray(message.intensities, dtype=np.float64)[valid, None])
        names.append("intensity")
    data = np.hstack(columns).astype("<f4")
    return PointCloud2(
        header=header,
        height=1,
        width=len(data),
        fields=[
            PointField(name=name, offset=4 * index, datatype=PointField.FLOAT32, count=1)
            for index, name in enumerate(names)
        ],
        point_step=4 * len(names),
        row_step=4 * len(names) * len(data),
        data=np.frombuffer(data.tobytes(), dtype=np.uint8),
        is_dense=True,
    )


def cloud_points(message: PointCloud2) -> NDArray[np.float64]:
    """Return the points of a cloud in its own frame, of shape (n, 3).

    Raises:
        TypeError: It has no fields x, y and z of floats.
        ValueError: It has less data than its size says.
    """
    points, _ = _fields(message)
    return np.stack([points[name].astype(np.float64) for name in "xyz"], axis=-1).reshape(-1, 3)


def _fields(message: PointCloud2) -> tuple[NDArray[np.void], NDArray[np.uint8]]:
    """Return the coordinates of a cloud as views on a copy of its data, and that copy. Raises as `cloud_points`."""
    formats = {PointField.FLOAT32: "f4", PointField.FLOAT64: "f8"}
    fields = {field.name: field for field in message.fields}
    wrong = [name for name in "xyz" if name not in fields or fields[name].datatype not in formats]
    if wrong:
        raise TypeError(f"the cloud has no field {wrong[0]!r} of floats; its fields are {', '.join(fields)}")
    order = ">" if message.is_bigendian else "<"
    offsets = [fields[name].offset for name in "xyz"]
    kinds = [order + formats[fields[name].datatype] for name in "xyz"]
    row = message.row_step or message.point_step * message.width
    data = np.array(np.asarray(message.data, dtype=np.uint8))
    if len(data) < row * message.height or row < message.point_step * message.width:
        raise ValueError(f"a cloud of {message.height} x {message.width} points has only {len(data)} bytes")
    dtype = np.dtype({"names": list("xyz"), "formats": kinds, "offsets": offsets, "itemsize": message.point_step})
    return np.ndarray((message.height, message.width), dtype, data, strides=(row, message.point_step)), data


def _cloud(message: PointCloud2, pose: Pose, header: Header) -> PointCloud2:
    """Move the points of a cloud; fields other than x, y and z stay as they are."""
    points, data = _fields(message)
    stacked = np.stack([points[name].astype(np.float64) for name in "xyz"], axis=-1)
    placed = stacked @ rotation_matrix(pose).T + pose.translation
    for index, name in enumerate("xyz"):
        points[name] = placed[..., index]
    out = type(message)(header=header, height=message.height, width=message.width, fields=message.fields)
    out.is_bigendian, out.is_dense = message.is_bigendian, message.is_dense
    out.point_step, out.row_step, out.data = message.point_step, message.row_step, data
    return out


CONVERSIONS: dict[str, Conversion] = {
    "PointStamped": _point,
    "PolygonStamped": _polygon,
    "PoseStamped": _pose,
    "PoseWithCovarianceStamped": _pose_with_covariance,
    "TwistStamped": _twist,
    "Vector3Stamped": _vector,
    "WrenchStamped": _wrench,
    "LaserScan": _scan,
    "PointCloud2": _cloud,
}
"""The conversions by the name of the class, which rclpy's message classes share."""
