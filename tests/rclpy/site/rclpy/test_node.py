"""Nodes."""

from __future__ import annotations

import gc
import weakref
from typing import Any

import pytest
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.exceptions import (
    InvalidHandle,
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NotInitializedException,
)
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from tests.cases import slow


def test_a_node_needs_a_context() -> None:
    """That has begun, and not ended."""
    with pytest.raises(NotInitializedException, match="cannot create node"):
        Node("node")


def test_names_come_from_the_code_and_from_outside() -> None:
    """What the command line says wins; a node's own arguments win over it."""
    rclpy.init(args=["me", "--ros-args", "-r", "__ns:=/outer", "-r", "t:=/u", "-p", "rate:=2.5"])
    node = Node("node", namespace="ns")
    assert (node.get_name(), node.get_namespace()) == ("node", "/outer")
    assert node.get_fully_qualified_name() == "/outer/node"
    assert node.create_publisher(String, "t", 1).topic_name == "/u"
    assert node.declare_parameter("rate", 1.0).value == 2.5
    own = Node("own", cli_args=["--ros-args", "-r", "__node:=renamed", "-r", "__ns:=/mine"])
    assert own.get_fully_qualified_name() == "/mine/renamed"
    alone = Node("alone", use_global_arguments=False)
    assert alone.get_fully_qualified_name() == "/alone"
    assert alone.get_logger().name == "alone"


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda node: Node("a?"), InvalidNodeNameException),
        (lambda node: Node("a", namespace="b?"), InvalidNamespaceException),
        (lambda node: Node("a", cli_args=["--ros-args", "-r", "no-rule"]), RuntimeError),
        (lambda node: Node("a", cli_args=["--ros-args", "--what"]), RuntimeError),
        (lambda node: node.create_publisher(String, "t?", 1), InvalidTopicNameException),
        (lambda node: node.create_subscription(String, "/4", print, 1), InvalidTopicNameException),
        (lambda node: node.create_client(AddTwoInts, "s?"), InvalidServiceNameException),
        (lambda node: node.create_publisher(String, "{what}", 1), ValueError),
        (lambda node: node.create_publisher(String, "t", "deep"), TypeError),
        (lambda node: node.create_publisher(AddTwoInts, "t", 1), RuntimeError),
        (lambda node: node.create_client(String, "s"), RuntimeError),
        (lambda node: setattr(node, "handle", 3), AttributeError),
    ],
)
def test_what_is_wrong_is_said_at_once(node: Node, make: Any, error: type[Exception]) -> None:
    """And nothing is made."""
    before = node.get_topic_names_and_types(), node.get_node_names()
    with pytest.raises(error):
        make(node)
    assert (node.get_topic_names_and_types(), node.get_node_names()) == before


def test_entities_live_from_their_making_to_their_destruction(node: Node) -> None:
    """Nobody has to spin."""
    publisher = node.create_publisher(String, "t", 1)
    subscription = node.create_subscription(String, "t", print, 1)
    client = node.create_client(AddTwoInts, "s")
    service = node.create_service(AddTwoInts, "s", print)
    assert publisher in node.publishers
    assert list(node.subscriptions) == [subscription]
    assert list(node.clients) == [client]
    assert service in node.services
    assert publisher.get_subscription_count() == 1
    assert client.wait_for_service(5)
    assert node.destroy_subscription(subscription)
    assert node.count_subscribers("t") == 0
    assert node.destroy_client(client)
    assert not node.destroy_client(client)


def test_a_destroyed_node_is_gone_with_all_it_had(node: Node) -> None:
    """Twice is harmless; what it had is of no more use."""
    other = Node("other")
    publisher = other.create_publisher(String, "t", 1)
    timer = other.create_timer(1.0, print)
    other.destroy_node()
    other.destroy_node()
    assert node.get_node_names() == ["node"]
    assert node.count_publishers("/t") == 0
    for use in (lambda: publisher.publish(String()), timer.is_ready, other.get_name):
        with pytest.raises(InvalidHandle):
            use()
    with Node("block") as block:
        assert "block" in node.get_node_names()
    assert block.handle.is_destroyed
    rclpy.shutdown()
    node.destroy_node()


def test_users_attributes_are_their_own(node: Node) -> None:
    """Whatever names of ours a stand-in might be expected to have."""

    class Own(Node):
        def __init__(self) -> None:
            super().__init__("own")
            for name in ("_executor", "_timers", "_logger", "_clock", "_parameters", "_name", "_lock", "_loop", "log"):
                setattr(self, name, None)

    own, executor = Own(), SingleThreadedExecutor()
    calls: list[int] = []
    own.create_timer(0.001, lambda: calls.append(1))
    executor.add_node(own)
    executor.spin_once(timeout_sec=1)
    assert calls == [1]
    own.get_logger().info("still there")
    own.destroy_node()


def test_parameters_may_be_declared_from_outside(node: Node) -> None:
    """All that are given."""
    given: list[Parameter[Any]] = [Parameter("a", value=1), Parameter("b.c", value="x")]
    other = Node("other", parameter_overrides=given, automatically_declare_parameters_from_overrides=True)
    assert other.get_parameter("b.c").value == "x"
    assert other.describe_parameter("a").dynamic_typing


@slow
def test_an_executor_does_not_keep_a_node(node: Node) -> None:
    """That nobody else has."""
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    reference = weakref.ref(executor)
    del executor
    gc.collect()
    assert reference() is None or node.executor is reference()


def test_a_node_is_waited_for(node: Node) -> None:
    """By its full name, or one without the slash."""
    assert node.wait_for_node("node", 1.0)
    assert not node.wait_for_node("/nobody", 0.01)


def test_what_code_knows_from_within(node: Node) -> None:
    """Can be read, and a class may have its own; the default group can be replaced."""

    class Own(Node):
        def __init__(self) -> None:
            super().__init__("own")
            self._logger: Any = "mine"

    assert node._logger is node.get_logger()
    assert node._clock is node.get_clock()
    assert Own()._logger == "mine"
    group = ReentrantCallbackGroup()
    node._default_callback_group = group
    assert node.default_callback_group is group
    assert node.create_timer(1.0, lambda: None).callback_group is group
