"""Waiting for one message."""

from __future__ import annotations

import threading

from std_msgs.msg import String

import rclpy
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message


def test_the_first_message_is_returned_though_nobody_spins(node: Node) -> None:
    """And the subscription is gone afterwards."""
    publisher = node.create_publisher(String, "t", 1)

    def publish() -> None:
        while not publisher.get_subscription_count():
            pass
        publisher.publish(String(data="a"))

    threading.Thread(target=publish).start()
    assert wait_for_message(String, node, "t") == (True, String(data="a"))
    assert publisher.get_subscription_count() == 0


def test_waiting_ends_in_time_and_with_the_context(node: Node) -> None:
    """Without a message."""
    assert wait_for_message(String, node, "t", time_to_wait=0.01) == (False, None)
    threading.Timer(0.02, rclpy.shutdown).start()
    assert wait_for_message(String, node, "t") == (False, None)
