"""Publishers."""

from __future__ import annotations

import pytest
from std_msgs.msg import Int32, String
from visualization_msgs.msg import Marker

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


def test_first_messages_are_checked(node: Node, spin: Spinner, caplog: pytest.LogCaptureFixture) -> None:
    """A contradiction is told once, with its line, and the messages are sent all the same."""
    heard: list[str] = []
    node.create_subscription(Marker, "marker", lambda marker: heard.append(marker.ns), 10)
    publisher = node.create_publisher(Marker, "marker", 10)
    for name in ("a", "b"):
        publisher.publish(Marker(ns=name))
    spin(lambda: heard == ["a", "b"])
    [told] = [text for text in caplog.messages if "color.a" in text]
    assert told.startswith("test_publisher.py:")
    assert told.endswith("/marker: color.a is 0, so that the marker is invisible: set it to 1.0")


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
