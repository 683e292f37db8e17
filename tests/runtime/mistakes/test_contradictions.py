"""Messages whose fields contradict each other."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np
import pytest

from graphflow.msgs.geometry_msgs.msg import Pose, PoseStamped, Quaternion, Vector3
from graphflow.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid, Path
from graphflow.msgs.sensor_msgs.msg import (
    BatteryState,
    CompressedImage,
    Image,
    JointState,
    LaserScan,
    NavSatFix,
    PointCloud2,
    PointField,
)
from graphflow.msgs.std_msgs.msg import ColorRGBA, Header
from graphflow.msgs.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from graphflow.msgs.visualization_msgs.msg import Marker, MarkerArray
from graphflow.runtime.endpoints.publishers import WITH_CONTRADICTIONS
from graphflow.runtime.mistakes.contradictions import CHECKED, CHECKS, FirstMessages

BYTES = np.zeros(12, np.uint8)
FLAT = Pose(orientation=Quaternion(z=1.57, w=0.0))
PLACED = Header(frame_id="map")
RED, CUBE = ColorRGBA(r=1.0, a=1.0), Vector3(x=0.1, y=0.1, z=0.1)


class _Host:
    log = logging.getLogger("graphflow.test")


def told(message: Any, caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the warnings about a message that is published twice."""
    host: Any = _Host()
    first = FirstMessages(host, type(message).SCHEMA.name, "/x")
    for _ in range(2):
        if first.is_open:
            first.check(message)
    return [text.partition("/x: ")[2] for text in caplog.messages]


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (LaserScan(ranges=[1.0] * 4, range_max=3.0), "angle_increment is 0, so that all 4 ranges are in one direction"),
        (LaserScan(ranges=[1.0] * 4, angle_increment=1.5), "range_max is 0, so that receivers drop all ranges"),
        (LaserScan(ranges=[1.0] * 360, angle_min=-180.0, angle_max=179.0, angle_increment=1.0), "are in radians"),
        (LaserScan(ranges=[1.0] * 4, angle_increment=1.5, range_max=3.0), "header.frame_id is empty"),
        (NavSatFix(latitude=126.9, longitude=37.5), "latitude goes from -90 to 90, and is 126.9"),
        (BatteryState(percentage=85.0), "percentage goes from 0.0 to 1.0, and is 85"),
    ],
    ids=lambda value: value[:20] if isinstance(value, str) else type(value).__name__,
)
def test_readings(message: Any, text: str, caplog: pytest.LogCaptureFixture) -> None:
    """Angles, ranges, positions on the earth and shares of one."""
    [found] = told(message, caplog)
    assert text in found


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (OccupancyGrid(info=MapMetaData(width=3, height=3), data=[0] * 8), "info.width * info.height is 9"),
        (OccupancyGrid(info=MapMetaData(width=3, height=3), data=[0] * 9), "info.resolution is 0"),
        (Image(height=2, step=5, data=BYTES, encoding="rgb8"), "data has 12 bytes, and step * height is 10"),
        (Image(height=2, step=6, data=BYTES), "there is no encoding ''"),
        (PointCloud2(height=1, row_step=8, data=BYTES), "row_step * height is 8"),
        (PointCloud2(height=1, row_step=12, data=BYTES), "fields is empty"),
        (Image(height=2, step=6, data=BYTES, encoding="RGB8"), "there is no encoding 'RGB8'; did you mean 'rgb8'?"),
        (OccupancyGrid(info=MapMetaData(width=3, height=1, resolution=0.1), data=[0, 1, 0]), "occupied cells are 100"),
        (CompressedImage(data=BYTES), "format is empty: it is 'jpeg' or 'png'"),
    ],
    ids=lambda value: value[:20] if isinstance(value, str) else type(value).__name__,
)
def test_pictures_maps_and_clouds(message: Any, text: str, caplog: pytest.LogCaptureFixture) -> None:
    """Sizes, encodings and fields of their data."""
    [found] = told(message, caplog)
    assert text in found


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (
            Image(width=6, height=2, step=6, data=BYTES, encoding="rgb8"),
            "step is 6, and a row of 6 pixels in rgb8 has 18 bytes",
        ),
        (
            PointCloud2(
                height=1, row_step=12, point_step=6, data=BYTES, fields=[PointField(name="z", offset=4, datatype=7)]
            ),
            "fields reach beyond point_step, the 6 bytes of a point",
        ),
        (
            JointTrajectory(joint_names=["a"], points=[JointTrajectoryPoint(), JointTrajectoryPoint()]),
            "time_from_start of a point is not later than that of the point before",
        ),
        (JointState(name=["a", "b"], position=[0.0]), "position has 1 values, and name has 2"),
        (
            LaserScan(ranges=[1.0] * 180, angle_max=6.26, angle_increment=0.01744, range_max=3.0),
            "ranges has 180 values, and the angles and angle_increment are those of 360",
        ),
        (PoseStamped(pose=FLAT), "the orientation's length is 1.57 and not 1"),
        (Path(poses=[PoseStamped(), PoseStamped(pose=FLAT)]), "write z = math.sin(yaw / 2), w = math.cos(yaw / 2)"),
        (JointTrajectory(joint_names=["a"], points=[JointTrajectoryPoint(positions=[0.0, 1.0])]), "joint_names has 1"),
    ],
    ids=lambda value: value[:20] if isinstance(value, str) else type(value).__name__,
)
def test_poses_and_joints(message: Any, text: str, caplog: pytest.LogCaptureFixture) -> None:
    """Orientations, and values for each joint."""
    [found] = told(message, caplog)
    assert text in found


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (Marker(scale=CUBE, color=ColorRGBA(r=255.0, a=1.0)), "colors go from 0.0 to 1.0, and not to 255"),
        (Marker(header=Header(frame_id="/map"), color=RED, scale=CUBE), "write header.frame_id = 'map'"),
        (MarkerArray(markers=[Marker(color=RED, scale=CUBE)] * 2), "two markers have the same ns and id"),
        (Marker(scale=CUBE), "color.a is 0, so that the marker is invisible"),
        (MarkerArray(markers=[Marker(color=RED)]), "scale is 0, so that the marker is invisible"),
    ],
    ids=lambda value: value[:20] if isinstance(value, str) else type(value).__name__,
)
def test_markers(message: Any, text: str, caplog: pytest.LogCaptureFixture) -> None:
    """Markers that nobody would see are named."""
    [found] = told(message, caplog)
    assert text in found


@pytest.mark.parametrize(
    "message",
    [
        *(LaserScan(), OccupancyGrid(), Image(), PointCloud2(), JointState(), BatteryState(), Path()),
    ],
    ids=lambda value: type(value).__name__,
)
def test_empty_messages(message: Any, caplog: pytest.LogCaptureFixture) -> None:
    """They have nothing to contradict."""
    assert told(message, caplog) == []


@pytest.mark.parametrize(
    "message",
    [
        OccupancyGrid(header=PLACED, info=MapMetaData(width=3, height=3, resolution=0.05), data=[0] * 9),
        OccupancyGrid(header=PLACED, info=MapMetaData(width=3, height=1, resolution=0.05), data=[-1, 100, 0]),
        OccupancyGrid(header=PLACED, info=MapMetaData(width=3, height=1, resolution=0.05), data=[1, 60, 0]),
        Image(height=2, step=6, data=BYTES, encoding="mono8"),
        PointCloud2(
            header=PLACED, height=1, row_step=12, data=BYTES, fields=[PointField(name="x", datatype=7)], point_step=4
        ),
        CompressedImage(format="jpeg", data=BYTES),
    ],
    ids=lambda value: type(value).__name__,
)
def test_sound_pictures_maps_and_clouds(message: Any, caplog: pytest.LogCaptureFixture) -> None:
    """Sizes and data fit; a map may have any share of occupation."""
    assert told(message, caplog) == []


@pytest.mark.parametrize(
    "message",
    [
        LaserScan(header=PLACED, ranges=[1.0] * 4, angle_increment=1.5, angle_max=4.5, range_max=3.0),
        JointState(name=["a", "b"], position=[0.0, 1.0]),
        BatteryState(percentage=float("nan")),
        Marker(header=PLACED, color=RED, scale=CUBE),
        NavSatFix(latitude=37.5, longitude=127.0),
        MarkerArray(markers=[Marker(id=i, color=RED, scale=CUBE) for i in range(2)]),
        Marker(action=Marker.DELETEALL),
    ],
    ids=lambda value: type(value).__name__,
)
def test_other_sound_messages(message: Any, caplog: pytest.LogCaptureFixture) -> None:
    """Complete ones, values that are not known, and markers that are taken away."""
    assert told(message, caplog) == []


def test_the_first_messages(caplog: pytest.LogCaptureFixture) -> None:
    """The check ends after some messages, and leaves fields of wrong types to the encoder."""
    host: Any = _Host()
    first = FirstMessages(host, "sensor_msgs/msg/LaserScan", "/scan")
    wrong: Any = LaserScan()
    wrong.ranges = None
    for _ in range(CHECKED):
        assert first.is_open
        first.check(wrong)
    assert not first.is_open
    assert caplog.messages == []


def test_the_types() -> None:
    """Publishers ask for the check of exactly the types that have one, and import it for no others."""
    assert set(CHECKS) == WITH_CONTRADICTIONS
