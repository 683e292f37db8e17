"""The archetypes of Rerun by which messages are shown."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Iterator
from typing import Protocol, TypeAlias

import numpy as np
import rerun as rr

from graphflow.description import parse
from graphflow.errors import GraphFileError
from graphflow.introspect.messages.images import NotShown, pixels
from graphflow.maps import GridMap
from graphflow.msgs.base import Message
from graphflow.msgs.geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    Pose,
    PoseArray,
    PoseStamped,
    PoseWithCovarianceStamped,
    Twist,
    TwistStamped,
)
from graphflow.msgs.nav_msgs.msg import OccupancyGrid, Odometry, Path
from graphflow.msgs.rcl_interfaces.msg import Log
from graphflow.msgs.sensor_msgs.msg import CompressedImage, Image, Imu, JointState, LaserScan, PointCloud2
from graphflow.msgs.std_msgs.msg import Header, String
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.msgs.turtlesim.msg import Pose as TurtlePose
from graphflow.tf.messages import cloud_points, scan_points
from graphflow.viewer.rerun.markers import marker_shapes
from graphflow.viewer.rerun.shapes import Logged, robot_shapes

DESCRIPTION = "robot_description"
"""The last part of the topic of a robot's description."""
ARROW = 0.3
"""Metres of the arrow that a pose is drawn as."""
_LEVELS = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "CRITICAL"}
_DEPTHS = {"16UC1": ("<u2", 1000.0), "mono16": ("<u2", 1000.0), "32FC1": ("<f4", 1.0)}
"""The type of a depth, and how many of its units are a metre."""

Show: TypeAlias = Callable[..., Iterator[Logged]]
"""Takes a path and a message of the type that it is for."""


def shown(topic: str, type_name: str, message: Message) -> Iterator[Logged]:
    """Yield what is logged for a message; nothing for a type that is not shown, or a message that is malformed.

    Args:
        topic: Its name, below whose path everything is logged.
    """
    path = topic.lstrip("/")
    show = _SHOWN.get(type_name)
    if show is None:
        return
    try:
        yield from show(path, message)
    except (NotShown, GraphFileError, ValueError, TypeError) as error:
        yield "log/not_shown", "", rr.TextLog(f"{topic}: {error}", level="WARN")


def is_shown(type_name: str) -> bool:
    """Whether messages of a type are shown."""
    return type_name in _SHOWN


class Stamped(Protocol):
    """A message with a header."""

    @property
    def header(self) -> Header: ...


def frame_of(message: Stamped) -> str:
    """Return the frame of a message's header, without a slash in front."""
    return message.header.frame_id.lstrip("/")


def _transforms(_: str, message: TFMessage) -> Iterator[Logged]:
    for one in message.transforms:
        t, r = one.transform.translation, one.transform.rotation
        child, parent = one.child_frame_id.lstrip("/"), one.header.frame_id.lstrip("/")
        made = rr.Transform3D(
            translation=[t.x, t.y, t.z],
            quaternion=rr.Quaternion(xyzw=[r.x, r.y, r.z, r.w]),
            child_frame=child,
            parent_frame=parent,
        )
        yield f"tf/{child}", "", made


def _scan(path: str, message: LaserScan) -> Iterator[Logged]:
    yield path, frame_of(message), rr.Points3D(scan_points(message), radii=[0.02], colors=[[255, 107, 94]])


def _cloud(path: str, message: PointCloud2) -> Iterator[Logged]:
    points = cloud_points(message)
    yield path, frame_of(message), rr.Points3D(points[np.isfinite(points).all(axis=1)])


def _image(path: str, message: Image) -> Iterator[Logged]:
    if message.encoding in _DEPTHS:
        kind, metre = _DEPTHS[message.encoding]
        data = np.frombuffer(bytes(message.data), kind)
        if data.size < message.width * message.height:
            raise NotShown(f"an image of {message.width} x {message.height} has {data.size} values")
        depth = data[: message.width * message.height].reshape(message.height, message.width)
        yield path, "", rr.DepthImage(np.nan_to_num(depth, posinf=0.0), meter=metre)
    else:
        yield path, "", rr.Image(pixels(message))


def _compressed(path: str, message: CompressedImage) -> Iterator[Logged]:
    kind = "image/png" if "png" in message.format else "image/jpeg"
    yield path, "", rr.EncodedImage(contents=bytes(message.data), media_type=kind)


def _map(path: str, message: OccupancyGrid) -> Iterator[Logged]:
    grid = GridMap.from_msg(message)
    height, width = grid.cells.shape
    x, y, yaw = grid.origin
    made = rr.GridMap(
        data=np.ascontiguousarray(grid.cells[::-1]).view(np.uint8).tobytes(),  # pictures begin at the top
        format=rr.components.ImageFormat(width=width, height=height, color_model="L", channel_datatype="U8"),
        cell_size=grid.resolution,
        translation=[x, y, 0.0],
        rotation_axis_angle=rr.RotationAxisAngle([0, 0, 1], yaw),
        colormap=rr.components.Colormap.RvizMap,
    )
    yield path, frame_of(message), made


def _path(path: str, message: Path) -> Iterator[Logged]:
    points = [(p.pose.position.x, p.pose.position.y, p.pose.position.z) for p in message.poses]
    yield path, frame_of(message), rr.LineStrips3D([points], radii=[0.015], colors=[[126, 224, 138]])


def _poses(*poses: Pose) -> rr.Arrows3D:
    origins, vectors = [], []
    for pose in poses:
        p, q = pose.position, pose.orientation
        origins.append((p.x, p.y, p.z))
        ahead = (1 - 2 * (q.y**2 + q.z**2), 2 * (q.x * q.y + q.w * q.z), 2 * (q.x * q.z - q.w * q.y))
        vectors.append([ARROW * part for part in ahead])
    return rr.Arrows3D(origins=origins, vectors=vectors, colors=[[240, 179, 90]] * len(origins))


def _odometry(path: str, message: Odometry) -> Iterator[Logged]:
    yield path, frame_of(message), _poses(message.pose.pose)
    yield from _twist(path, message.twist.twist)


def _pose(path: str, message: PoseStamped) -> Iterator[Logged]:
    yield path, frame_of(message), _poses(message.pose)


def _estimate(path: str, message: PoseWithCovarianceStamped) -> Iterator[Logged]:
    yield path, frame_of(message), _poses(message.pose.pose)


def _pose_array(path: str, message: PoseArray) -> Iterator[Logged]:
    yield path, frame_of(message), _poses(*message.poses)


def _point(path: str, message: PointStamped) -> Iterator[Logged]:
    yield path, frame_of(message), rr.Points3D([[message.point.x, message.point.y, message.point.z]], radii=[0.05])


def _polygon(path: str, message: PolygonStamped) -> Iterator[Logged]:
    corners = [(p.x, p.y, p.z) for p in message.polygon.points]
    yield path, frame_of(message), rr.LineStrips3D([[*corners, *corners[:1]]], radii=[0.01])


def _twist(path: str, message: Twist) -> Iterator[Logged]:
    yield f"plots/{path}/linear.x", "", rr.Scalars([message.linear.x])
    yield f"plots/{path}/angular.z", "", rr.Scalars([message.angular.z])


def _stamped_twist(path: str, message: TwistStamped) -> Iterator[Logged]:
    yield from _twist(path, message.twist)


def _imu(path: str, message: Imu) -> Iterator[Logged]:
    turn, pull = message.angular_velocity, message.linear_acceleration
    for name, vector in (("angular_velocity", turn), ("linear_acceleration", pull)):
        for axis, value in zip("xyz", (vector.x, vector.y, vector.z), strict=True):
            yield f"plots/{path}/{name}.{axis}", "", rr.Scalars([value])


def _joints(path: str, message: JointState) -> Iterator[Logged]:
    for name, position in zip(message.name, message.position, strict=False):
        yield f"plots/{path}/{name}", "", rr.Scalars([float(position)])


def _field(name: str) -> Show:
    def show(path: str, message: Message) -> Iterator[Logged]:
        yield f"plots/{path}/{name}", "", rr.Scalars([float(getattr(message, name))])

    return show


def _turtle(path: str, message: TurtlePose) -> Iterator[Logged]:
    yield path, "", rr.Points3D([[message.x, message.y, 0.0]], radii=[0.15])
    yield f"plots/{path}/linear_velocity", "", rr.Scalars([message.linear_velocity])


def _log(_: str, message: Log) -> Iterator[Logged]:
    yield f"log/{message.name}", "", rr.TextLog(message.msg, level=_LEVELS.get(message.level, "INFO"))


def _text(path: str, message: String) -> Iterator[Logged]:
    if path.rpartition("/")[2] == DESCRIPTION:
        yield from robot_shapes(parse(message.data, path), pathlib.Path.cwd())
    else:
        yield f"log/{path}", "", rr.TextLog(message.data)


_SHOWN: dict[str, Show] = {
    "tf2_msgs/msg/TFMessage": _transforms,
    "sensor_msgs/msg/LaserScan": _scan,
    "sensor_msgs/msg/PointCloud2": _cloud,
    "sensor_msgs/msg/Image": _image,
    "sensor_msgs/msg/CompressedImage": _compressed,
    "sensor_msgs/msg/Imu": _imu,
    "sensor_msgs/msg/JointState": _joints,
    "sensor_msgs/msg/BatteryState": _field("percentage"),
    "sensor_msgs/msg/Range": _field("range"),
    "sensor_msgs/msg/Temperature": _field("temperature"),
    "nav_msgs/msg/OccupancyGrid": _map,
    "nav_msgs/msg/Path": _path,
    "nav_msgs/msg/Odometry": _odometry,
    "geometry_msgs/msg/PoseStamped": _pose,
    "geometry_msgs/msg/PoseWithCovarianceStamped": _estimate,
    "geometry_msgs/msg/PoseArray": _pose_array,
    "geometry_msgs/msg/PointStamped": _point,
    "geometry_msgs/msg/PolygonStamped": _polygon,
    "geometry_msgs/msg/Twist": _twist,
    "geometry_msgs/msg/TwistStamped": _stamped_twist,
    "visualization_msgs/msg/Marker": marker_shapes,
    "visualization_msgs/msg/MarkerArray": marker_shapes,
    "turtlesim/msg/Pose": _turtle,
    "rcl_interfaces/msg/Log": _log,
    "std_msgs/msg/String": _text,
    **{f"std_msgs/msg/{kind}": _field("data") for kind in ("Float32", "Float64", "Int32", "Int64", "UInt32", "Bool")},
}
"""The functions that show messages, by type."""
