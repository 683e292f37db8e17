"""Publishers."""

from __future__ import annotations

import pytest
from std_msgs.msg import Int32, String

import rclpy
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.serialization import serialize_message
from tests.rclpy.conftest import Spinner


def test_messages_and_their_bytes_are_sent(node: Node, spin: Spinner) -> None:
    """At once, and a message may be used again; anything else is refused."""
    heard: list[str] = []
    node.create_subscription(String, "t", lambda message: heard.append(message.data), 10)
    publisher = node.create_publisher(String, "t", 10)
    assert (publisher.topic_name, publisher.get_subscription_count()) == ("/t", 1)
    message = String(data="a")
    publisher.publish(message)
    message.data = "b"
    publisher.publish(serialize_message(message))
    spin(lambda: heard == ["a", "b"])
    with pytest.raises(TypeError, match="Expected"):
        publisher.publish(Int32())
    assert publisher.wait_for_all_acked()
    publisher.assert_liveliness()


def test_one_that_was_destroyed_sends_nothing(node: Node) -> None:
    """And neither does one whose context has ended."""
    publisher, other = node.create_publisher(String, "t", 10), node.create_publisher(String, "t", 10)
    assert node.destroy_publisher(publisher)
    assert not node.destroy_publisher(publisher)
    with pytest.raises(InvalidHandle):
        publisher.publish(String())
    rclpy.shutdown()
    with pytest.raises(RuntimeError, match="context is invalid"):
        other.publish(String())
