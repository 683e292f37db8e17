"""The result of a lookup: the pose of one frame in another at a time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from graphflow.errors import DeclarationError
from graphflow.msgs.geometry_msgs.msg import Transform as TransformMessage
from graphflow.msgs.geometry_msgs.msg import TransformStamped
from graphflow.msgs.std_msgs.msg import Header
from graphflow.tf import messages
from graphflow.tf.planar import Pose2D
from graphflow.tf.poses import Pose, Quaternion, Vector, from_rpy, to_rpy
from graphflow.times import HasFields, Time

Stamp: TypeAlias = Time | HasFields | None
"""A time: a `Time`, a message's stamp, or None for the latest."""


@dataclass(frozen=True, slots=True)
class Transform:
    """The pose of the frame `child` in `parent` at a time; it converts coordinates in `child` to those in `parent`.

    Attributes:
        stamp: The time for which it holds; 0 if it always does.
        pose: A translation in metres and a rotation as a quaternion (x, y, z, w) of length 1.
    """

    parent: str
    child: str
    pose: Pose
    stamp: Time = Time(0)  # noqa: RUF009 - frozen

    @classmethod
    def of(
        cls,
        parent: str,
        child: str,
        translation: Vector = (0.0, 0.0, 0.0),
        *,
        rpy: Vector = (0.0, 0.0, 0.0),
        rotation: Quaternion | None = None,
        stamp: Time = Time(0),  # noqa: B008 - frozen
    ) -> Transform:
        """Return a transform from its numbers.

        Args:
            translation: x, y, z in metres.
            rpy: Roll, pitch and yaw in radians: rotations about the fixed axes x, y and z in turn.
            rotation: A quaternion (x, y, z, w) in place of `rpy`.
            stamp: Its time; by default the time of sending.

        Raises:
            DeclarationError: The translation or `rpy` is not three numbers.
        """
        x, y, z = _three(translation, "the translation", "(x, y, z)")
        turned = from_rpy(*_three(rpy, "rpy", "(0.0, 0.0, yaw)")) if rotation is None else rotation
        return cls(parent, child, Pose((x, y, z), turned), stamp)

    @classmethod
    def from_msg(cls, message: TransformStamped) -> Transform:
        """Convert a `geometry_msgs/TransformStamped`."""
        stamp = Time.from_msg(message.header.stamp)
        return cls(message.header.frame_id, message.child_frame_id, pose_of(message.transform), stamp)

    def to_msg(self) -> TransformStamped:
        """Convert to a `geometry_msgs/TransformStamped`."""
        return stamped(self.pose, self.parent, self.child, self.stamp.nanoseconds)

    @property
    def translation(self) -> Vector:
        """x, y, z in metres."""
        return self.pose.translation

    @property
    def rotation(self) -> Quaternion:
        """The quaternion x, y, z, w, of length 1."""
        return self.pose.rotation

    @property
    def rpy(self) -> Vector:
        """Roll, pitch and yaw in radians."""
        return to_rpy(self.pose.rotation)

    @property
    def yaw(self) -> float:
        """The rotation about z in radians, from -pi to pi."""
        return to_rpy(self.pose.rotation)[2]

    @property
    def planar(self) -> Pose2D:
        """x, y and yaw: the pose of something that stands on a floor."""
        return Pose2D(self.pose.translation[0], self.pose.translation[1], self.yaw)

    def matrix(self) -> NDArray[np.float64]:
        """Return the homogeneous matrix, of shape (4, 4)."""
        out = np.eye(4)
        out[:3, :3] = messages.rotation_matrix(self.pose)
        out[:3, 3] = self.pose.translation
        return out

    def inverse(self) -> Transform:
        """Return the pose of `parent` in `child`."""
        return Transform(self.child, self.parent, self.pose.inverse(), self.stamp)

    def __matmul__(self, other: Transform) -> Transform:
        """Chain two transforms: `map_to_odom @ odom_to_base`.

        Raises:
            ValueError: The child of the first is not the parent of the second.
        """
        if self.child != other.parent:
            chain = f"{self.parent} -> {self.child} and {other.parent} -> {other.child}"
            raise ValueError(f"{chain} do not join: {self.child!r} is not {other.parent!r}")
        return Transform(self.parent, other.child, self.pose.of(other.pose), max(self.stamp, other.stamp))

    def points(self, points: ArrayLike) -> NDArray[np.float64]:
        """Convert points in `child` to `parent`: an array of shape (..., 3), in metres, to a new array."""
        return np.asarray(points, dtype=np.float64) @ messages.rotation_matrix(self.pose).T + self.pose.translation

    def vectors(self, vectors: ArrayLike) -> NDArray[np.float64]:
        """Rotate vectors, which have no place, such as velocities: an array of shape (..., 3)."""
        return np.asarray(vectors, dtype=np.float64) @ messages.rotation_matrix(self.pose).T

    def apply(self, message: Any) -> Any:
        """Convert a message with a header from `child` to `parent`; a `LaserScan` becomes a `PointCloud2`.

        Raises:
            TypeError: Messages of its type cannot be converted; the text lists those that can.
        """
        return messages.convert(message, self.pose, Header(stamp=self.to_msg().header.stamp, frame_id=self.parent))


def pose_of(transform: TransformMessage) -> Pose:
    """Convert a `geometry_msgs/Transform` to a pose."""
    t, r = transform.translation, transform.rotation
    return Pose((t.x, t.y, t.z), (r.x, r.y, r.z, r.w))


def stamp_ns(at: Stamp) -> int:
    """Return a time in nanoseconds; 0 for the latest. Raises TypeError for a number."""
    if isinstance(at, (int, float)):
        raise TypeError(f"at= takes a Time or a message's stamp, not {at!r}; the time now is self.clock.now()")
    return 0 if at is None else Time.from_msg(at).nanoseconds if not isinstance(at, Time) else at.nanoseconds


def stamped(pose: Pose, parent: str, child: str, stamp_ns: int) -> TransformStamped:
    """Convert the pose of `child` in `parent` to a message."""
    out = TransformStamped()
    fill(out, pose, parent, child, stamp_ns)
    return out


def fill(message: TransformStamped, pose: Pose, parent: str, child: str, stamp_ns: int) -> None:
    """Fill in a message with the pose of `child` in `parent`."""
    header, transform = message.header, message.transform
    header.stamp.sec, header.stamp.nanosec = divmod(stamp_ns, 10**9)
    header.frame_id, message.child_frame_id = parent, child
    t, r = transform.translation, transform.rotation
    (t.x, t.y, t.z), (r.x, r.y, r.z, r.w) = pose


def _three(numbers: Vector, what: str, form: str) -> Vector:
    """Check three numbers of a caller's.

    Raises:
        DeclarationError: They are not three numbers.
    """
    try:
        x, y, z = map(float, numbers)
    except (TypeError, ValueError):
        raise DeclarationError(f"{what} is three numbers, {form}, and not {numbers!r}") from None
    return x, y, z
