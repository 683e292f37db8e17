"""Messages that a program publishes and ends, before any subscription has found it."""

from __future__ import annotations

import pytest
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import String
from tf2_ros import StaticTransformBroadcaster

import rclpy
from rclpy.impl.nodes import internals_of
from rclpy.impl.watches import unheard
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

Caplog = pytest.LogCaptureFixture


def told(caplog: Caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if "has received" in record.getMessage()]


def publish(node: Node, times: int = 1) -> None:
    publisher = node.create_publisher(String, "chat", 10)
    for _ in range(times):
        publisher.publish(String())


def test_what_nobody_has_heard(node: Node, caplog: Caplog) -> None:
    """Told when the node leaves, by itself or with the context; not of one that has published nothing."""
    way = "if one should have, publish when publisher.get_subscription_count() is not 0"
    publish(node)
    node.create_publisher(String, "still", 10)
    node.destroy_node()
    assert told(caplog) == [f"/chat: no subscription has received the 1 message that was published; {way}"]
    publish(Node("other"), times=2)
    rclpy.shutdown()
    assert told(caplog)[1:] == [f"/chat: no subscription has received the 2 messages that were published; {way}"]


@pytest.mark.parametrize("is_heard", [True, False])
def test_what_is_kept_for_late_subscriptions(node: Node, caplog: Caplog, is_heard: bool) -> None:
    """It goes with the node; nothing is told where a subscription has had it."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    if is_heard:
        Node("ear").create_subscription(String, "chat", print, latched)
    node.create_publisher(String, "chat", latched).publish(String())
    node.destroy_node()
    text = (
        "/chat: /node ends, and with it the message that it keeps for late subscriptions: keep it running, with "
        "rclpy.spin(node)"
    )
    assert [told for told in caplog.messages if "keeps" in told] == ([] if is_heard else [text])


@pytest.mark.parametrize("is_latched", [True, False])
def test_a_program_that_is_interrupted(node: Node, caplog: Caplog, is_latched: bool) -> None:
    """Nothing is told: the user has stopped it."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(String, "chat", latched if is_latched else 10).publish(String())
    for _ in range(2):
        internals_of(node).life.interrupt()
    node.destroy_node()
    assert [text for text in caplog.messages if text.startswith("/chat: ")] == []


def test_a_static_transform(node: Node, caplog: Caplog) -> None:
    """Its broadcaster has the publisher, which keeps it for late subscriptions."""
    transform = TransformStamped(child_frame_id="laser")
    transform.header.frame_id = "base"
    StaticTransformBroadcaster(node).sendTransform(transform)
    node.destroy_node()
    assert [text for text in caplog.messages if text.startswith("/tf_static: /node ends, and with it the message")]


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
