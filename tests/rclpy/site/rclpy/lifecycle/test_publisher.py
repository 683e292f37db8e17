"""Publishers of nodes that have a life cycle."""

import pytest
from std_msgs.msg import String

import rclpy
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn


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


def test_a_publisher_that_is_not_active(capfd: pytest.CaptureFixture[str]) -> None:
    """Warns once, in rclcpp's words and with the next step, until the node has been active."""
    rclpy.init()
    node = LifecycleNode("lamp")
    publisher = node.create_lifecycle_publisher(String, "light", 1)
    steps = (node.trigger_configure, node.trigger_activate, node.trigger_deactivate, node.trigger_shutdown)
    for step in (None, *steps):
        if step is not None:
            step()
        publisher.publish(String())
        publisher.publish(String())
    words = "Trying to publish message on the topic '/light', but the publisher is not activated: /lamp is"
    found = [line.partition(": ")[2] for line in capfd.readouterr().err.splitlines() if words in line]
    configure, activate = (f"graphflow lifecycle set /lamp {step}" for step in ("configure", "activate"))
    assert found == [
        f"{words} unconfigured, to activate it: {configure} && {activate}",
        f"{words} inactive, to activate it: {activate}",
    ]


class Silent(LifecycleNode):
    """A node whose callback replaces the one that activates its publishers."""

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Succeed, and activate nothing."""
        return TransitionCallbackReturn.SUCCESS


def test_an_activation_without_super(capfd: pytest.CaptureFixture[str]) -> None:
    """As in ROS 2, the publisher sends nothing; one warning at once names the callback and its missing line."""
    rclpy.init()
    node = Silent("lamp")
    publisher = node.create_lifecycle_publisher(String, "light", 1)
    node.trigger_configure()
    node.trigger_activate()
    warning = capfd.readouterr().err
    publisher.publish(String())
    assert not publisher.is_activated
    assert capfd.readouterr().err == ""
    assert "the publisher of '/light' is not activated, and sends nothing: on_activate (" in warning
    assert "test_publisher.py:51) has to end with return super().on_activate(state), which activates it" in warning


def test_a_publisher_of_an_active_node(capfd: pytest.CaptureFixture[str]) -> None:
    """As in ROS 2, it sends nothing; the warning tells where to create it, and does not blame the callback."""
    rclpy.init()
    node = LifecycleNode("lamp")
    node.trigger_configure()
    node.trigger_activate()
    node.create_lifecycle_publisher(String, "light", 1).publish(String())
    warning = capfd.readouterr().err
    assert "not activated: it was created while /lamp was active: create it in on_configure" in warning
    assert "super()" not in warning
