"""Transforms that are sent without the names of their frames."""

from __future__ import annotations

import pytest
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Header
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

from rclpy.node import Node

REFUSED = "and every listener drops it"


def test_it_is_told_at_the_sender(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """Once for each line."""
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
    line = test_it_is_told_at_the_sender.__code__.co_firstlineno + 8
    assert [message for r in caplog.records if REFUSED in (message := r.getMessage())] == [
        f"test_unnamed_frames.py:{line}: this transform has no child_frame_id, {REFUSED}; write "
        "transform.child_frame_id = 'base_link' before",
        f"test_unnamed_frames.py:{line + 1}: this transform has no header.frame_id, {REFUSED}; write "
        "transform.header.frame_id = 'base_link' before",
        f"test_unnamed_frames.py:{line + 2}: this transform says where 'base' is in itself, {REFUSED}; "
        "child_frame_id is the frame that is placed in frame_id",
    ]
