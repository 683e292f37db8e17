"""Messages whose fields contradict each other, so that receivers drop or misread them: a map with too few cells.

ROS 2 sends them silently; RViz and the navigation stack report some of them at the other end. Only the first messages
of a publisher are checked: a program fills in all of its messages in the same way.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Any, TypeAlias

from graphflow.analysis.user_code import short_place, users_frame
from graphflow.names import did_you_mean
from graphflow.runtime.part import Host

Fields: TypeAlias = Any
"""A message of the type that a check is for, of graphflow or of rclpy."""
Check: TypeAlias = Callable[[Fields], str]
"""Returns a sentence about a message, or ""."""

CHECKED = 10
"""The number of messages of a publisher that are checked."""
_TOLERANCE = 0.1
"""The greatest difference of a quaternion's length from 1: receivers normalize small ones."""
_BYTES = {"mono8": 1, "8UC1": 1, "mono16": 2, "16UC1": 2, "rgb8": 3, "bgr8": 3, "rgba8": 4, "bgra8": 4, "32FC1": 4}
"""The bytes of a pixel, by encoding."""
_ENCODINGS = re.compile(
    r"(mono|rgb|bgr|rgba|bgra)(8|16)|(8|16)[US]C\d*|32SC\d*|(32|64)FC\d*|bayer_(rggb|bggr|gbrg|grbg)(8|16)|"
    r"yuv422(_yuy2)?|uyvy|yuyv|nv\d\d"
)
"""The encodings of sensor_msgs/image_encodings.hpp."""
_POLE = 90.0
"""The greatest latitude, in degrees."""
_SIZES = {3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 8: 8}
"""The bytes of `PointField.datatype`, for those of more than one."""
_TURNS = 10.0
"""Radians beyond which an angle of a scanner counts as degrees."""
_SLACK = 0.05
"""The part by which the number of ranges may differ from the angles, since some drivers round them."""
_UNSEEN = 0
"""`Marker.action` of markers that are shown."""


class FirstMessages:
    """The check of one publisher's first messages, with one warning at most.

    Args:
        type_name: One of `CHECKS`.
        name: The topic.
    """

    def __init__(self, host: Host, type_name: str, name: str) -> None:
        self._host, self._name = host, name
        self._check = CHECKS[type_name]
        self._needs_frame = type_name in _PLACED
        self._left = CHECKED

    @property
    def is_open(self) -> bool:
        """Whether the next message is to be checked."""
        return self._left > 0

    def check(self, message: Fields) -> None:
        """Warn of a contradiction in a message."""
        self._left -= 1
        try:
            text = self._check(message) or _frame(message, is_needed=self._needs_frame)
        except (AttributeError, TypeError, ValueError):
            return  # a field of a wrong type, which is an error of its own when the message is encoded
        if text:
            self._left = 0
            caller = users_frame(sys._getframe(1))
            place = f"{short_place(caller.f_code.co_filename, caller.f_lineno)}: " if caller is not None else ""
            self._host.log.warning("%s%s: %s", place, self._name, text)


def _frame(message: Fields, *, is_needed: bool) -> str:
    """Return a sentence about the frame in a message's header."""
    frame = message.header.frame_id if hasattr(message, "header") else None
    if frame is not None and frame.startswith("/"):
        return f"frames have no slash in front: write header.frame_id = {frame.lstrip('/')!r}"
    if frame == "" and is_needed and _has_content(message):
        return "header.frame_id is empty, so that nothing can place it: set it, as in 'base_scan' or 'map'"
    return ""


def _has_content(message: Fields) -> bool:
    """Whether a message has data, or is a marker to be shown."""
    return (
        bool(len(getattr(message, "ranges", getattr(message, "data", ())))) or getattr(message, "action", 1) == _UNSEEN
    )


def _battery(message: Fields) -> str:
    if message.percentage > 1.0:
        return f"percentage goes from 0.0 to 1.0, and is {message.percentage:g}"
    return ""


def _cloud(message: Fields) -> str:
    size, count = message.row_step * message.height, len(message.data)
    if size != count:
        return f"data has {count} bytes, and row_step * height is {size}"
    if any(f.offset + _SIZES.get(f.datatype, 1) * max(f.count, 1) > message.point_step for f in message.fields):
        return f"fields reach beyond point_step, the {message.point_step} bytes of a point"
    if count and not message.fields:
        return "fields is empty, so that nothing can read data: describe x, y and z with PointField"
    return ""


def _image(message: Fields) -> str:
    size, count = message.step * message.height, len(message.data)
    if size != count:
        return f"data has {count} bytes, and step * height is {size}; step is the number of bytes in a row"
    if count and not _ENCODINGS.fullmatch(message.encoding):
        return f"there is no encoding {message.encoding!r}{did_you_mean(message.encoding.lower(), _BYTES)}"
    width = message.width * _BYTES.get(message.encoding, 0)
    if count and message.step < width:
        return f"step is {message.step}, and a row of {message.width} pixels in {message.encoding} has {width} bytes"
    return ""


def _joints(message: Fields) -> str:
    names = len(message.name)
    for field in ("position", "velocity", "effort"):
        if (count := len(getattr(message, field))) not in (0, names):
            return f"{field} has {count} values, and name has {names}: give each joint one, in the order of name"
    return ""


def _map(message: Fields) -> str:
    import numpy as np  # where there are maps, it is loaded already

    cells, count = message.info.width * message.info.height, len(message.data)
    if cells != count:
        return f"data has {count} cells, and info.width * info.height is {cells}"
    if count and not message.info.resolution > 0:
        return "info.resolution is 0: set the metres per cell"
    if count and np.max(message.data) == 1:
        return "its greatest cell is 1, which is free: occupied cells are 100, free ones 0 and unknown ones -1"
    return ""


def _compressed(message: Fields) -> str:
    if len(message.data) and not message.format:
        return "format is empty: it is 'jpeg' or 'png', and data has the bytes of such a file; pixels go into an Image"
    return ""


def _fix(message: Fields) -> str:
    if abs(message.latitude) > _POLE:
        return f"latitude goes from -90 to 90, and is {message.latitude:g}"
    return ""


def _marker(message: Fields) -> str:
    if message.action != _UNSEEN:
        return ""
    if not message.color.a and not len(message.colors) and not message.mesh_resource:
        return "color.a is 0, so that the marker is invisible: set it to 1.0"
    if max(message.color.r, message.color.g, message.color.b, message.color.a) > 1.0:
        return "colors go from 0.0 to 1.0, and not to 255"
    if not (message.scale.x or message.scale.y or message.scale.z):
        return "scale is 0, so that the marker is invisible: set its size in metres"
    return _turn(message.pose.orientation)


def _markers(message: Fields) -> str:
    shown = [(m.ns, m.id) for m in message.markers if m.action == _UNSEEN]
    if len(set(shown)) < len(shown):
        return "two markers have the same ns and id, and the second replaces the first: number them by id"
    return next(filter(None, map(_marker, message.markers)), "")


def _scan(message: Fields) -> str:
    count = len(message.ranges)
    if max(abs(message.angle_min), abs(message.angle_max)) > _TURNS:
        return f"angle_min and angle_max are in radians, and are {message.angle_min:g} and {message.angle_max:g}"
    if message.angle_increment and message.angle_max > message.angle_min:
        told = (message.angle_max - message.angle_min) / message.angle_increment
        if count and abs(told - count) > _SLACK * count + 2:
            return f"ranges has {count} values, and the angles and angle_increment are those of {told + 1:.0f}"
    if count > 1 and not message.angle_increment:
        return f"angle_increment is 0, so that all {count} ranges are in one direction: set it in radians"
    if count and not message.range_max > message.range_min:
        return f"range_max is {message.range_max:g}, so that receivers drop all ranges: set it in metres"
    return ""


def _trajectory(message: Fields) -> str:
    names = len(message.joint_names)
    for point in message.points:
        if (count := len(point.positions)) not in (0, names):
            return f"a point has {count} positions, and joint_names has {names}"
    times = [point.time_from_start.sec + point.time_from_start.nanosec * 1e-9 for point in message.points]
    if any(after <= before for before, after in pairwise(times)):
        return "time_from_start of a point is not later than that of the point before"
    return ""


def _turn(q: Fields) -> str:
    length = math.sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w)
    if abs(length - 1.0) > _TOLERANCE:
        text = f"the orientation's length is {length:.3g} and not 1, so it is no quaternion of a turn"
        return f"{text}; for a yaw write z = math.sin(yaw / 2), w = math.cos(yaw / 2)"
    return ""


CHECKS: dict[str, Check] = {
    "geometry_msgs/msg/Pose": lambda m: _turn(m.orientation),
    "geometry_msgs/msg/PoseStamped": lambda m: _turn(m.pose.orientation),
    "geometry_msgs/msg/PoseWithCovarianceStamped": lambda m: _turn(m.pose.pose.orientation),
    "nav_msgs/msg/OccupancyGrid": _map,
    "nav_msgs/msg/Odometry": lambda m: _turn(m.pose.pose.orientation),
    "nav_msgs/msg/Path": lambda m: _first(_turn(p.pose.orientation) for p in m.poses),
    "sensor_msgs/msg/BatteryState": _battery,
    "sensor_msgs/msg/CompressedImage": _compressed,
    "sensor_msgs/msg/Image": _image,
    "sensor_msgs/msg/JointState": _joints,
    "sensor_msgs/msg/LaserScan": _scan,
    "sensor_msgs/msg/NavSatFix": _fix,
    "sensor_msgs/msg/PointCloud2": _cloud,
    "trajectory_msgs/msg/JointTrajectory": _trajectory,
    "visualization_msgs/msg/Marker": _marker,
    "visualization_msgs/msg/MarkerArray": _markers,
}
"""The check of each type, which returns a sentence, or ""."""
_PLACED = {
    "nav_msgs/msg/OccupancyGrid",
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/PointCloud2",
    "visualization_msgs/msg/Marker",
}
"""The types whose messages are of no use without a frame."""


def _first(texts: Iterable[str]) -> str:
    return next(filter(None, texts), "")
