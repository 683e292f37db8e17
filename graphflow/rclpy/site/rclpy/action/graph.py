"""The actions in the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.node import Node


_FEEDBACK = "/_action/feedback"
_MESSAGE = "_FeedbackMessage"


def _actions(topics: list[tuple[str, list[str]]]) -> list[tuple[str, list[str]]]:
    return [
        (name.removesuffix(_FEEDBACK), [t.removesuffix(_MESSAGE) for t in types])
        for name, types in topics
        if name.endswith(_FEEDBACK)
    ]


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> list[tuple[str, list[str]]]:
    """Return the actions that a node uses, with their types. Raises NodeNameNonExistentError."""
    return _actions(node.get_subscriber_names_and_types_by_node(remote_node_name, remote_node_namespace))


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> list[tuple[str, list[str]]]:
    """Return the actions that a node offers, with their types. Raises NodeNameNonExistentError."""
    return _actions(node.get_publisher_names_and_types_by_node(remote_node_name, remote_node_namespace))


def get_action_names_and_types(node: Node) -> list[tuple[str, list[str]]]:
    """Return all actions with their types."""
    return _actions(node.get_topic_names_and_types())
