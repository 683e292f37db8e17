"""Access to nodes from graphflow's own side."""

from __future__ import annotations

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.nodes import internals_of, nodes_of
from rclpy.node import Node
from rclpy.utilities import get_default_context


def test_the_nodes_of_a_context(node: Node) -> None:
    """All that have not been destroyed."""
    other = rclpy.create_node("other")
    life = get_default_context().life
    assert life is not None
    assert nodes_of(life) == [node, other]
    other.destroy_node()
    assert nodes_of(life) == [node]


def test_the_internals_of_a_node(node: Node) -> None:
    """They have its entities."""
    timer = node.create_timer(10.0, lambda: None)
    assert timer in internals_of(node).timers


def test_the_internals_of_an_executor(node: Node) -> None:
    """They have its nodes."""
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    assert list(internals_of(executor).nodes) == [node]
