"""Destroying what a node has."""

from __future__ import annotations

from std_msgs.msg import String

from rclpy.node import Node
from tests.rclpy.conftest import Spinner


def test_what_is_destroyed_does_nothing_more(node: Node, spin: Spinner) -> None:
    """Though it had something to do."""
    heard: list[object] = []
    subscription = node.create_subscription(String, "t", heard.append, 10)
    node.create_publisher(String, "t", 10).publish(String())
    guard = node.create_guard_condition(lambda: heard.append(1))
    guard.trigger()
    timer = node.create_timer(0.0001, lambda: heard.append(2))
    assert node.destroy_subscription(subscription)
    assert node.destroy_guard_condition(guard)
    assert node.destroy_timer(timer)
    for _ in range(3):
        spin.executor.spin_once(timeout_sec=0.002)
    assert heard == []
    assert not node.destroy_timer(timer)


def test_events_of_an_endpoint_go_with_it(node: Node) -> None:
    """They are waitables of the node's."""
    before = len(list(node.waitables))
    publisher = node.create_publisher(String, "t", 1)
    assert len(list(node.waitables)) == before + 2
    assert node.destroy_publisher(publisher)
    assert len(list(node.waitables)) == before
