"""Expansion of topic and service names to full names."""

from __future__ import annotations

import re

from rclpy.exceptions import InvalidNamespaceException, InvalidNodeNameException, InvalidTopicNameException
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name
from rclpy.validate_topic_name import validate_topic_name


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the full name of a node's `topic_name`, before remapping.

    Raises:
        ValueError: One of the names is illegal, or contains an unknown substitution.
    """
    try:
        validate_topic_name(topic_name)
    except InvalidTopicNameException as error:
        raise ValueError(f"topic name is invalid: {error}") from None
    try:
        validate_node_name(node_name)
    except InvalidNodeNameException as error:
        raise ValueError(f"node name is invalid: {error}") from None
    try:
        validate_namespace(node_namespace)
    except InvalidNamespaceException as error:
        raise ValueError(f"node namespace is invalid: {error}") from None
    base = node_namespace.rstrip("/")
    known = {"node": node_name, "ns": node_namespace, "namespace": node_namespace}

    def substituted(match: re.Match[str]) -> str:
        if match[1] not in known:
            raise ValueError(f"unknown substitution: {match[0]} in topic name '{topic_name}'")
        return known[match[1]]

    name = re.sub(r"\{([^{}]*)\}", substituted, topic_name).replace("//", "/")
    if name.startswith("~"):
        return f"{base}/{node_name}{name[1:]}"
    return name if name.startswith("/") else f"{base}/{name}"
