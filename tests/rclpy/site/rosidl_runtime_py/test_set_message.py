"""Fields of messages set from plain data."""

from __future__ import annotations

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point32, PolygonStamped, PoseWithCovariance, Twist
from rosidl_runtime_py import set_message_fields
from sensor_msgs.msg import JointState


def test_values_are_converted() -> None:
    """As YAML gives them: whole numbers for floating ones, mappings for messages, lists of both."""
    twist = Twist()
    set_message_fields(twist, {"linear": {"x": 1, "y": "2.5"}})
    assert (twist.linear.x, twist.linear.y) == (1.0, 2.5)
    joints = JointState()
    set_message_fields(joints, {"name": ["a"], "position": [1]})
    assert (joints.name, joints.position.tolist()) == (["a"], [1.0])
    polygon = PolygonStamped()
    set_message_fields(polygon, {"polygon": {"points": [{"x": 1}, {}]}})
    assert polygon.polygon.points == [Point32(x=1.0), Point32()]
    pose = PoseWithCovariance()
    set_message_fields(pose, {"covariance": [1] * 36})
    assert pose.covariance.sum() == 36
    set_message_fields(polygon, {"header": {"stamp": Time(sec=3)}})
    assert polygon.header.stamp.sec == 3


def test_stamps_can_be_set_later() -> None:
    """Where `auto` and `now` are allowed to stand for them."""
    polygon = PolygonStamped()
    (auto,) = set_message_fields(polygon, {"header": "auto"}, expand_header_auto=True)
    (now,) = set_message_fields(polygon, {"header": {"stamp": "now"}}, expand_time_now=True)
    for stamp, seconds in ((auto, 5), (now, 6)):
        stamp(Time(sec=seconds))
        assert polygon.header.stamp.sec == seconds
    with pytest.raises(TypeError, match="Value 'auto' is expected to be a dictionary but is a str"):
        set_message_fields(polygon, {"header": "auto"})


def test_what_does_not_fit() -> None:
    """Is told as rclpy's programs expect it."""
    with pytest.raises(AttributeError):
        set_message_fields(Twist(), {"liner": {}})
    with pytest.raises(TypeError, match="expected to be a dictionary"):
        set_message_fields(Twist(), {"linear": 3})
    with pytest.raises(ValueError, match="could not convert"):
        set_message_fields(Twist(), {"linear": {"x": "fast"}})
    with pytest.raises(AssertionError):
        set_message_fields(PoseWithCovariance(), {"covariance": [1.0]})
