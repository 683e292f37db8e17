"""Messages in another frame."""

from __future__ import annotations

import math

import numpy as np
import pytest
from geometry_msgs.msg import Point32, PoseStamped, TransformStamped
from tf2_geometry_msgs import (
    PointStamped,
    PolygonStamped,
    PoseWithCovarianceStamped,
    Vector3Stamped,
    WrenchStamped,
    do_transform_point,
    do_transform_polygon_stamped,
    do_transform_pose,
    transform_covariance,
)
from tf2_py.core import message
from tf2_ros import Buffer

from graphflow.tf.poses import Pose

LEFT = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
S = 10**9


@pytest.fixture
def transform() -> TransformStamped:
    """The laser is one metre ahead, and looks to the left."""
    return message(Pose((1.0, 0.0, 0.0), LEFT), "base", "laser", S)


@pytest.fixture
def buffer(transform: TransformStamped) -> Buffer:
    """One that knows where the laser is."""
    out = Buffer()
    out.set_transform_static(transform)
    return out


def test_points_are_moved_and_vectors_turned(buffer: Buffer) -> None:
    """By a buffer, from the frame in their header."""
    point, vector, wrench = PointStamped(), Vector3Stamped(), WrenchStamped()
    for stamped in (point, vector, wrench):
        stamped.header.frame_id = "laser"
        stamped.header.stamp.sec = 7
    point.point.x = vector.vector.x = wrench.wrench.force.x = 2.0
    wrench.wrench.torque.y = 3.0
    moved = buffer.transform(point, "base")
    assert (moved.point.x, moved.point.y, moved.point.z) == pytest.approx((1.0, 2.0, 0.0))
    assert (moved.header.frame_id, moved.header.stamp.sec) == ("base", 7)
    turned = buffer.transform(vector, "base").vector
    assert (turned.x, turned.y, turned.z) == pytest.approx((0.0, 2.0, 0.0))
    pushed = buffer.transform(wrench, "base").wrench
    assert (pushed.force.y, pushed.torque.x) == pytest.approx((2.0, -3.0))


def test_poses_with_and_without_a_header(buffer: Buffer, transform: TransformStamped) -> None:
    """And with a covariance, whose axes turn."""
    stamped = PoseStamped()
    stamped.header.frame_id = "laser"
    stamped.pose.position.x = 2.0
    moved = buffer.transform(stamped, "base").pose
    assert moved == do_transform_pose(stamped.pose, transform)
    assert (moved.position.x, moved.position.y, moved.orientation.z) == pytest.approx((1.0, 2.0, LEFT[2]))
    sure = PoseWithCovarianceStamped()
    sure.header.frame_id = "laser"
    sure.pose.covariance[0], sure.pose.covariance[35] = 4.0, 0.5
    turned = np.reshape(buffer.transform(sure, "base").pose.covariance, (6, 6))
    assert (turned[0, 0], turned[1, 1], turned[5, 5]) == pytest.approx((0.0, 4.0, 0.5))
    assert transform_covariance(np.eye(6).ravel(), transform) == pytest.approx(np.eye(6).ravel())


def test_rotations_are_made_such() -> None:
    """A quaternion of another length turns as one of length 1, none as that of no rotation; results have w >= 0."""
    twice = message(Pose((1.0, 2.0, 3.0), (0.0, 0.0, 2.0, 2.0)), "base", "laser", S)
    point = PointStamped()
    point.point.x, point.point.y, point.point.z = 1.0, 2.0, 3.0
    moved = do_transform_point(point, twice).point
    assert (moved.x, moved.y, moved.z) == pytest.approx((-1.0, 3.0, 6.0))
    given = PoseStamped().pose
    given.orientation.w = -1.0
    turned = do_transform_pose(given, twice).orientation
    assert (turned.x, turned.y, turned.z, turned.w) == pytest.approx(LEFT)
    given.orientation.w = 0.0
    none = message(Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)), "base", "laser", S)
    assert do_transform_pose(given, none).orientation.w == 1.0


def test_the_points_of_a_polygon_are_moved(transform: TransformStamped) -> None:
    """All of them, into the frame of the transform's header."""
    polygon = PolygonStamped()
    polygon.polygon.points = [Point32(x=2.0), Point32(y=1.0)]
    moved = do_transform_polygon_stamped(polygon, transform)
    assert moved.header.frame_id == "base"
    assert [(round(p.x, 6), round(p.y, 6)) for p in moved.polygon.points] == [(1.0, 2.0), (0.0, 0.0)]
