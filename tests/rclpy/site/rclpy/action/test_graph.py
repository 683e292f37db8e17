"""The actions of the graph."""

from example_interfaces.action import Fibonacci

from rclpy.action import (
    ActionClient,
    ActionServer,
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.node import Node


def test_actions_are_known_by_their_feedback(node: Node) -> None:
    """Of all nodes, and of one."""
    other = Node("other")
    ActionServer(other, Fibonacci, "fib", print)
    ActionClient(node, Fibonacci, "fib")
    row = [("/fib", ["example_interfaces/action/Fibonacci"])]
    assert get_action_names_and_types(node) == row
    assert get_action_server_names_and_types_by_node(node, "other", "/") == row
    assert get_action_client_names_and_types_by_node(node, "node", "/") == row
    assert get_action_server_names_and_types_by_node(node, "node", "/") == []
