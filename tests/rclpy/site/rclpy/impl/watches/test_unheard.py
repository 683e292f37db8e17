"""Messages that a program publishes and ends, before any subscription has found it."""

from __future__ import annotations

import pytest
from std_msgs.msg import String

import rclpy
from rclpy.impl.watches import unheard
from rclpy.node import Node

Caplog = pytest.LogCaptureFixture


def told(caplog: Caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if "has received" in record.getMessage()]


def publish(node: Node, times: int = 1) -> None:
    publisher = node.create_publisher(String, "chat", 10)
    for _ in range(times):
        publisher.publish(String())


def test_what_nobody_has_heard(node: Node, caplog: Caplog) -> None:
    """Told when the node leaves, by itself or with the context; not of one that has published nothing."""
    way = "publish when publisher.get_subscription_count() is not 0"
    publish(node)
    node.create_publisher(String, "still", 10)
    node.destroy_node()
    assert told(caplog) == [f"/chat: no subscription has received the 1 message that was published: {way}"]
    publish(Node("other"), times=2)
    rclpy.shutdown()
    assert told(caplog)[1:] == [f"/chat: no subscription has received the 2 messages that were published: {way}"]


def test_what_was_heard_or_had_the_time(node: Node, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is told where there was a subscription for one of them, nor of a node that has lived for long."""
    publisher = node.create_publisher(String, "chat", 10)
    publisher.publish(String())
    subscription = node.create_subscription(String, "chat", lambda _: None, 10)
    publisher.publish(String())
    node.destroy_subscription(subscription)
    node.destroy_node()
    monkeypatch.setattr(unheard, "BRIEF", 0.0)
    publish(Node("other"))
    rclpy.shutdown()
    assert told(caplog) == []


def test_a_program_that_fails(node: Node, caplog: Caplog) -> None:
    """Has other worries."""
    publish(node)
    try:
        raise ValueError
    except ValueError:
        node.destroy_node()
    assert told(caplog) == []
