"""Saying where frames are that move."""

from __future__ import annotations

import threading

from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from tf2_ros.transform_broadcaster import TransformBroadcaster, as_list

from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message


def test_one_or_several() -> None:
    """Also what can be gone through only once."""
    one = TransformStamped()
    assert as_list(one) == [one]
    assert as_list(frame for frame in (one, one)) == [one, one]


def test_they_go_out_on_tf(node: Node) -> None:
    """Wherever the node is."""
    broadcaster = TransformBroadcaster(node)

    def send() -> None:
        while not broadcaster.pub_tf.get_subscription_count():
            pass
        broadcaster.sendTransform(TransformStamped(header=Header(frame_id="odom"), child_frame_id="base"))

    threading.Thread(target=send).start()
    came, message = wait_for_message(TFMessage, node, "/tf", time_to_wait=10)
    assert came
    assert [frame.child_frame_id for frame in message.transforms] == ["base"]
