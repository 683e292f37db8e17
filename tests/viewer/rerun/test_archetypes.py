"""Messages as archetypes of Rerun."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

rr = pytest.importorskip("rerun", reason="the extra `rerun` is not installed")

from graphflow.maps import GridMap
from graphflow.msgs import registry
from graphflow.msgs.geometry_msgs.msg import Polygon, PolygonStamped, Pose, PoseArray, PoseStamped, Twist
from graphflow.msgs.nav_msgs.msg import Odometry, Path
from graphflow.msgs.rcl_interfaces.msg import Log
from graphflow.msgs.sensor_msgs.msg import BatteryState, CompressedImage, Image, Imu, JointState, LaserScan, PointCloud2
from graphflow.msgs.std_msgs.msg import Float64, Header, String
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.msgs.turtlesim.msg import Pose as TurtlePose
from graphflow.tf import Transform
from graphflow.viewer.rerun import archetypes
from graphflow.viewer.rerun.archetypes import frame_of, is_shown, shown

HEADER = Header(frame_id="/base_scan")
IMAGE = Image(header=HEADER, encoding="rgb8", width=2, height=1, step=6, data=np.zeros(6, np.uint8))
DEPTH = Image(header=HEADER, encoding="32FC1", width=1, height=1, step=4, data=np.zeros(4, np.uint8))
MESSAGES: list[tuple[Any, str, type]] = [
    (TFMessage(transforms=[Transform.of("odom", "base").to_msg()]), "tf/base", rr.Transform3D),
    (LaserScan(header=HEADER, range_max=5.0, ranges=np.ones(3, np.float32)), "topic", rr.Points3D),
    (IMAGE, "topic", rr.Image),
    (DEPTH, "topic", rr.DepthImage),
    (CompressedImage(format="png", data=np.zeros(3, np.uint8)), "topic", rr.EncodedImage),
    (GridMap(np.zeros((2, 3), np.int8), 0.1).to_msg("map"), "topic", rr.GridMap),
    (Path(header=HEADER, poses=[PoseStamped(), PoseStamped()]), "topic", rr.LineStrips3D),
    (Odometry(header=HEADER), "topic", rr.Arrows3D),
    (PoseStamped(header=HEADER), "topic", rr.Arrows3D),
    (PoseArray(header=HEADER, poses=[Pose()]), "topic", rr.Arrows3D),
    (PolygonStamped(header=HEADER, polygon=Polygon()), "topic", rr.LineStrips3D),
    (Twist(), "plots/topic/linear.x", rr.Scalars),
    (Imu(), "plots/topic/angular_velocity.x", rr.Scalars),
    (JointState(name=["a"], position=[1.0]), "plots/topic/a", rr.Scalars),
    (BatteryState(), "plots/topic/percentage", rr.Scalars),
    (Float64(data=1.0), "plots/topic/data", rr.Scalars),
    (TurtlePose(), "topic", rr.Points3D),
    (Log(name="talker", msg="hello", level=30), "log/talker", rr.TextLog),
    (String(data="hello"), "log/topic", rr.TextLog),
]


@pytest.mark.parametrize(("message", "path", "kind"), MESSAGES, ids=[type(m[0]).__name__ for m in MESSAGES])
def test_messages(message: Any, path: str, kind: type) -> None:
    """Each has its place and its archetype."""
    type_name = type(message).SCHEMA.name
    assert is_shown(type_name)
    first = next(iter(shown("/topic", type_name, message)))
    assert first[0] == path
    assert isinstance(first[2], kind)


def test_every_type_that_is_shown_exists() -> None:
    """None is misspelt."""
    for name in archetypes._SHOWN:
        assert registry.message_schema(name).name == name


def test_frames() -> None:
    """The frame of a header, without a slash in front."""
    assert frame_of(LaserScan(header=HEADER)) == "base_scan"
    assert not is_shown("std_msgs/msg/Empty")
    assert list(shown("/t", "std_msgs/msg/Empty", Twist())) == []


@pytest.mark.parametrize(
    ("message", "said"),
    [
        (Image(encoding="strange", width=1, height=1), "the encoding 'strange' is unknown"),
        (Image(encoding="32FC1", width=5, height=5), "an image of 5 x 5 has 0 values"),
        (PointCloud2(width=1, height=1), "the cloud has no field 'x' of floats"),
    ],
)
def test_malformed_messages(message: Any, said: str) -> None:
    """They are told in the log of the recording, and nothing stops."""
    [(path, _, told)] = shown("/topic", type(message).SCHEMA.name, message)
    assert isinstance(told, rr.TextLog)
    assert path == "log/not_shown"
    assert said in str(told.text.as_arrow_array().to_pylist())
