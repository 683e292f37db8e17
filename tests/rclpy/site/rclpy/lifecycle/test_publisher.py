"""Publishers of nodes that have a life cycle."""

from std_msgs.msg import String

import rclpy
from rclpy.lifecycle import LifecycleNode


def test_it_sends_while_the_node_is_active() -> None:
    """What is published before and after is not sent."""
    rclpy.init()
    node = LifecycleNode("node")
    publisher = node.create_lifecycle_publisher(String, "t", 1)
    subscription = node.create_subscription(String, "t", print, 10)
    publisher.publish(String(data="a"))
    node.trigger_configure()
    node.trigger_activate()
    publisher.publish(String(data="b"))
    node.trigger_deactivate()
    publisher.publish(String(data="c"))
    taken = subscription.handle.take_message(String, False)  # type: ignore[attr-defined]
    assert taken[0].data == "b"
    assert subscription.handle.take_message(String, False) is None  # type: ignore[attr-defined]
    assert node.destroy_lifecycle_publisher(publisher)
