"""Validation of node names."""

from __future__ import annotations

import re

from rclpy.exceptions import InvalidNodeNameException


def validate_node_name(node_name: str) -> bool:
    """Return True for a legal name; raise InvalidNodeNameException otherwise."""
    if not node_name:
        raise InvalidNodeNameException(node_name, "node name must not be empty", 0)
    wrong = re.search(r"[^A-Za-z0-9_]", node_name)
    if wrong:
        text = "node name must not contain characters other than alphanumerics or '_'"
        raise InvalidNodeNameException(node_name, text, wrong.start())
    if node_name[0].isdigit():
        raise InvalidNodeNameException(node_name, "node name must not start with a number", 0)
    return True
