"""Messages in another frame."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from graphflow import Time
from graphflow.msgs.geometry_msgs.msg import (
    Point32,
    PointStamped,
    PolygonStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    TwistStamped,
    Vector3Stamped,
    WrenchStamped,
)
from graphflow.msgs.sensor_msgs.msg import LaserScan, PointCloud2, PointField
from graphflow.msgs.std_msgs.msg import Header, String
from graphflow.tf import Transform

LEFT = Transform.of("base", "laser", (1.0, 0.0, 0.0), rpy=(0.0, 0.0, math.pi / 2), stamp=Time(7_000_000_000))
IN_LASER = Header(frame_id="laser")


def xyz(vector: Any) -> Any:
    return pytest.approx((vector.x, vector.y, vector.z), abs=1e-9)


def test_points_are_moved_and_vectors_turned() -> None:
    """Each result has the header of the transform."""
    point = PointStamped(header=IN_LASER)
    point.point.x = 2.0
    moved = LEFT.apply(point)
    assert xyz(moved.point) == (1.0, 2.0, 0.0)
    assert (moved.header.frame_id, moved.header.stamp.sec) == ("base", 7)
    vector = Vector3Stamped(header=IN_LASER)
    vector.vector.x = 2.0
    assert xyz(LEFT.apply(vector).vector) == (0.0, 2.0, 0.0)
    wrench, twist = WrenchStamped(header=IN_LASER), TwistStamped(header=IN_LASER)
    wrench.wrench.force.x, wrench.wrench.torque.y = 2.0, 3.0
    twist.twist.linear.x, twist.twist.angular.z = 0.2, 1.0
    assert xyz(LEFT.apply(wrench).wrench.force) == (0.0, 2.0, 0.0)
    assert xyz(LEFT.apply(wrench).wrench.torque) == (-3.0, 0.0, 0.0)
    assert xyz(LEFT.apply(twist).twist.linear) == (0.0, 0.2, 0.0)
    assert xyz(LEFT.apply(twist).twist.angular) == (0.0, 0.0, 1.0)
    assert (point.point.x, vector.vector.x, wrench.wrench.force.x) == (2.0, 2.0, 2.0)


def test_poses_and_polygons() -> None:
    """A pose is moved and turned, and the axes of its covariance are turned."""
    pose = PoseStamped(header=IN_LASER)
    pose.pose.position.x = 2.0
    moved = LEFT.apply(pose).pose
    assert xyz(moved.position) == (1.0, 2.0, 0.0)
    assert (moved.orientation.z, moved.orientation.w) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))
    uncertain = PoseWithCovarianceStamped(header=IN_LASER)
    covariance = np.diag([4.0, 1.0, 9.0, 0.1, 0.2, 0.3])
    covariance[0, 2] = covariance[2, 0] = 0.7  # of x and z: x becomes y
    uncertain.pose.covariance = covariance.ravel()
    turned = np.reshape(LEFT.apply(uncertain).pose.covariance, (6, 6))
    assert np.allclose(np.diag(turned), [1.0, 4.0, 9.0, 0.2, 0.1, 0.3])
    assert np.allclose([turned[1, 2], turned[2, 1], turned[0, 2]], [0.7, 0.7, 0.0])
    polygon = PolygonStamped(header=IN_LASER)
    polygon.polygon.points = [Point32(x=2.0), Point32(y=1.0)]
    moved_points = LEFT.apply(polygon).polygon.points
    assert np.allclose([(p.x, p.y, p.z) for p in moved_points], [(1.0, 2.0, 0.0), (0.0, 0.0, 0.0)], atol=1e-6)


def points_of(cloud: PointCloud2) -> Any:
    return np.frombuffer(bytes(cloud.data), dtype="<f4").reshape(cloud.height * cloud.width, -1)


def test_a_scan() -> None:
    """It becomes a cloud of its valid beams, with their intensities."""
    scan = LaserScan(header=IN_LASER, angle_min=0.0, angle_increment=math.pi / 2, range_min=0.1, range_max=3.5)
    scan.ranges = np.array([2.0, math.inf, 9.0, 1.0], dtype=np.float32)
    cloud = LEFT.apply(scan)
    assert (cloud.header.frame_id, cloud.width, cloud.height, len(cloud.fields)) == ("base", 2, 1, 3)
    assert np.allclose(points_of(cloud), [[1.0, 2.0, 0.0], [2.0, 0.0, 0.0]], atol=1e-6)
    scan.intensities = np.array([5.0, 6.0, 7.0, 8.0], dtype=np.float32)
    assert list(points_of(LEFT.apply(scan))[:, 3]) == [5.0, 8.0]


@pytest.mark.parametrize(("order", "kind"), [("<", "f4"), (">", "f4"), ("<", "f8")])
def test_a_cloud(order: str, kind: str) -> None:
    """Its points are moved; other fields, padding and the order of bytes stay."""
    size = int(kind[1])
    datatype = PointField.FLOAT32 if kind == "f4" else PointField.FLOAT64
    offsets = [0, 8, 8 + size, 8 + 2 * size]
    formats = ["u1", *[order + kind] * 3]
    dtype = np.dtype({"names": ["rgb", "x", "y", "z"], "formats": formats, "offsets": offsets, "itemsize": 40})
    points = np.zeros((2, 3), dtype)
    points["x"], points["rgb"] = 2.0, 77
    rows = np.zeros((2, 130), np.uint8)  # ten bytes of padding at the end of each row
    rows[:, :120] = points.view(np.uint8).reshape(2, 120)
    fields = [PointField(name="rgb", offset=0, datatype=PointField.UINT8, count=1)]
    fields += [PointField(name=n, offset=8 + i * size, datatype=datatype, count=1) for i, n in enumerate("xyz")]
    cloud = PointCloud2(header=IN_LASER, height=2, width=3, fields=fields, point_step=40, row_step=130)
    cloud.is_bigendian, cloud.data = order == ">", rows.ravel()
    moved = LEFT.apply(cloud)
    found = np.asarray(moved.data).reshape(2, 130)[:, :120].copy().view(dtype)
    assert np.allclose(found["x"], 1.0)
    assert np.allclose(found["y"], 2.0)
    assert (found["rgb"] == 77).all()
    assert (moved.row_step, moved.header.frame_id) == (130, "base")
    assert np.asarray(cloud.data).reshape(2, 130)[0, :120].copy().view(dtype)["x"][0] == 2.0


def test_what_cannot_be_converted() -> None:
    """The error lists what can be."""
    with pytest.raises(TypeError, match=r"a String cannot be transformed; these can: PointStamped, .*, and arrays by"):
        LEFT.apply(String())
    with pytest.raises(TypeError, match="the cloud has no field 'x' of floats; its fields are a"):
        LEFT.apply(PointCloud2(header=IN_LASER, fields=[PointField(name="a", datatype=PointField.FLOAT32, count=1)]))
    fields = [PointField(name=n, offset=4 * i, datatype=PointField.FLOAT32, count=1) for i, n in enumerate("xyz")]
    with pytest.raises(ValueError, match="a cloud of 10 x 10 points has only 0 bytes"):
        LEFT.apply(PointCloud2(header=IN_LASER, fields=fields, height=10, width=10, point_step=12))
