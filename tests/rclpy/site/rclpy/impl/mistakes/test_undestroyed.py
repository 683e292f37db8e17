"""Calls that destroy nothing, since what they are given is of another kind."""

from __future__ import annotations

import inspect
from typing import Any

import pytest
from std_msgs.msg import String
from std_srvs.srv import Trigger

from rclpy.action import ActionClient
from rclpy.node import Node

Caplog = pytest.LogCaptureFixture


def nothing(*_: object) -> None:
    """Be called."""


def test_what_cannot_be_destroyed_so(node: Any, caplog: Caplog) -> None:
    """Each line is told once, with the call that is probably meant."""
    node.timer = node.create_timer(10.0, nothing)
    node.sub = node.create_subscription(String, "chat", nothing, 10)
    for _ in range(2):
        line = inspect.currentframe().f_lineno + 1  # type: ignore[union-attr]
        assert node.destroy_timer(nothing) is False
        assert node.destroy_subscription("chat") is False
        assert node.destroy_publisher(node.sub) is False
        assert node.destroy_service("switch") is False
        assert node.destroy_rate(node.timer) is False
    where = [f"test_undestroyed.py:{line + n}:" for n in range(5)]
    assert caplog.messages == [
        f"{where[0]} destroy_timer destroys nothing, since it takes a Timer and got the function nothing; "
        "write destroy_timer(self.timer)",
        f"{where[1]} destroy_subscription destroys nothing, since it takes a Subscription and got 'chat'; "
        "write destroy_subscription(self.sub)",
        f"{where[2]} destroy_publisher destroys nothing, since it takes a Publisher and got a Subscription; "
        "write destroy_subscription(...)",
        f"{where[3]} destroy_service destroys nothing, since it takes a Service and got 'switch'; "
        "write destroy_service(self.service), with what create_service has returned",
        f"{where[4]} destroy_rate destroys nothing, since it takes a Rate and got a Timer; write destroy_timer(...)",
    ]


def test_an_action_client(node: Any, caplog: Caplog) -> None:
    """It has a method of its own."""
    from example_interfaces.action import Fibonacci

    node.client = ActionClient(node, Fibonacci, "fibonacci")
    assert node.destroy_client(node.client) is False
    assert caplog.messages[0].endswith("it takes a Client and got an ActionClient; write self.client.destroy()")
    node.client.destroy()


def test_what_code_that_cleans_up_does(node: Any, caplog: Caplog) -> None:
    """None, what is destroyed already, and what is another node's are refused as ROS 2 does it, without a word."""
    other = Node("other")
    timer = node.create_timer(10.0, nothing)
    assert node.destroy_timer(timer)
    assert not node.destroy_timer(timer)
    assert not node.destroy_timer(None)
    assert not node.destroy_timer(other.create_timer(10.0, nothing))
    with pytest.raises(AttributeError):
        node.destroy_rate(None)
    assert not node.destroy_client(other.create_client(Trigger, "switch"))
    assert caplog.messages == []
    other.destroy_node()
