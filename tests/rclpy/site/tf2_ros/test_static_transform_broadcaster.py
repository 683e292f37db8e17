"""Saying where frames are that do not move."""

from __future__ import annotations

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage
from tf2_ros import StaticTransformBroadcaster

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.wait_for_message import wait_for_message


def test_who_joins_later_hears_all(node: Node) -> None:
    """Of each frame the last that was said."""
    broadcaster = StaticTransformBroadcaster(node)
    for parent, frame in (("base", "laser"), ("base", "camera"), ("arm", "camera")):
        message = TransformStamped(child_frame_id=frame)
        message.header.frame_id = parent
        broadcaster.sendTransform(message)
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    came, found = wait_for_message(TFMessage, node, "/tf_static", qos_profile=qos, time_to_wait=10)
    assert came
    assert [(t.header.frame_id, t.child_frame_id) for t in found.transforms] == [("base", "laser"), ("arm", "camera")]
