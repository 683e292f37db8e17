"""The names of nodes, and those that they resolve."""

from __future__ import annotations

import pytest

import rclpy
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node


def test_a_nodes_own_names(node: Node) -> None:
    """In its namespace."""
    other = Node("n", namespace="/ns")
    assert (other.get_name(), other.get_namespace(), other.get_fully_qualified_name()) == ("n", "/ns", "/ns/n")
    assert node.get_fully_qualified_name() == "/node"


@pytest.mark.parametrize(("name", "full"), [("a", "/ns/a"), ("/a", "/a"), ("~/a", "/ns/n/a"), ("b", "/ns/c")])
def test_resolved_names(name: str, full: str) -> None:
    """In the node's namespace, remapped; a destroyed node resolves none."""
    rclpy.init()
    other = Node("n", namespace="/ns", cli_args=["--ros-args", "-r", "b:=c"])
    assert other.resolve_topic_name(name) == other.resolve_service_name(name) == full
    assert other.resolve_topic_name("b", only_expand=True) == "/ns/b"
    other.destroy_node()
    with pytest.raises(InvalidHandle):
        other.resolve_topic_name(name)


def test_wrong_names_are_refused(node: Node) -> None:
    """For both kinds."""
    for resolve in (node.resolve_topic_name, node.resolve_service_name):
        with pytest.raises(ValueError, match="topic name is invalid"):
            resolve("a b")
