"""Transforms that every listener drops."""

from __future__ import annotations

import pytest
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header
from tf2_py import BufferCore
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

from rclpy.impl.mistakes import refused_transforms
from rclpy.node import Node

REFUSED = "and every listener drops it"


def test_names_of_frames(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """A transform without a frame is reported at the sender, once for each line."""
    moving, still = TransformBroadcaster(node), StaticTransformBroadcaster(node)
    named = TransformStamped(header=Header(frame_id="odom"), child_frame_id="base")
    half = TransformStamped(header=Header(frame_id="odom"))
    other = TransformStamped(child_frame_id="base")
    same = TransformStamped(header=Header(frame_id="base"), child_frame_id="base")
    for _ in range(2):
        moving.sendTransform([named, half])
        still.sendTransform(other)
        moving.sendTransform(same)
        moving.sendTransform(named)
    line = test_names_of_frames.__code__.co_firstlineno + 8
    assert [message for r in caplog.records if REFUSED in (message := r.getMessage())] == [
        f"test_refused_transforms.py:{line}: this transform has no child_frame_id, {REFUSED}; write "
        "half.child_frame_id = 'base_link' before",
        f"test_refused_transforms.py:{line + 1}: this transform has no header.frame_id, {REFUSED}; write "
        "other.header.frame_id = 'base_link' before",
        f"test_refused_transforms.py:{line + 2}: this transform says where 'base' is in itself, {REFUSED}; "
        "child_frame_id is the frame that is placed in frame_id",
    ]


def stamped(rotation: Quaternion, x: float = 0.0) -> TransformStamped:
    transform = Transform(rotation=rotation, translation=Vector3(x=x))
    return TransformStamped(header=Header(frame_id="odom"), child_frame_id="base", transform=transform)


EULER = "angles are converted: x, y, z, w = tf_transformations.quaternion_from_euler(roll, pitch, yaw), in radians"
ABOUT_Z = (
    "for an angle in radians write transform.rotation.z = math.sin(angle / 2) and transform.rotation.w = "
    "math.cos(angle / 2)"
)


@pytest.mark.parametrize(
    ("rotation", "length", "way"),
    [
        (Quaternion(z=90.0, w=0.0), "90", ABOUT_Z),
        (Quaternion(x=0.1, z=0.5, w=1.0), "1.122", EULER),
        (Quaternion(x=1.0, z=2.0, w=2.0), "3", "divide x, y, z and w by that length"),
        (Quaternion(w=0.0), "0", "no rotation has w = 1.0"),
    ],
)
def test_rotations(node: Node, caplog: pytest.LogCaptureFixture, rotation: Quaternion, length: str, way: str) -> None:
    """One that is not normalized is told at the sender, once, with what was meant."""
    refused_transforms._reported.clear()
    moving = TransformBroadcaster(node)
    for _ in range(2):
        moving.sendTransform(stamped(rotation))
    line = test_rotations.__code__.co_firstlineno + 14
    assert [message for r in caplog.records if REFUSED in (message := r.getMessage())] == [
        f"test_refused_transforms.py:{line}: the rotation of 'base' is a quaternion of length {length}, not 1, "
        f"{REFUSED}; {way}"
    ]


def test_numbers_that_are_none(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """They are named."""
    for one in (stamped(Quaternion(), x=float("nan")), stamped(Quaternion(z=float("inf")))):
        refused_transforms.check(one)
    told = [message.partition(": ")[2] for r in caplog.records if REFUSED in (message := r.getMessage())]
    refused_transforms._reported.clear()
    refused_transforms.check(stamped(Quaternion(z=float("inf"))))
    told += [caplog.messages[-1].partition(": ")[2]]
    assert told == [
        f"translation.x of the transform of 'base' is nan, {REFUSED}; check the number before it is sent",
        f"rotation.z of the transform of 'base' is inf, {REFUSED}; check the number before it is sent",
    ]


@pytest.mark.parametrize(
    "rotation",
    [Quaternion(), Quaternion(z=1.0, w=0.0), Quaternion(z=0.7071, w=0.7071), Quaternion(x=-0.5, y=0.5, z=0.5, w=0.501)],
)
def test_rotations_that_listeners_take(rotation: Quaternion, caplog: pytest.LogCaptureFixture) -> None:
    """They are sent without a word, within the same tolerance."""
    refused_transforms._reported.clear()
    refused_transforms.check(stamped(rotation, x=1e300))
    assert caplog.messages == []
    BufferCore().set_transform(stamped(rotation), "test")
    assert caplog.messages == []
