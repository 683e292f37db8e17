"""Methods that hide what every node has."""

from __future__ import annotations

import pytest

from rclpy.impl.mistakes.hidden_properties import refuse_hidden_properties
from rclpy.node import Node


class Serving(Node):
    def handle(self, request: object, response: object) -> object:  # type: ignore[override]
        return response


class Own(Node):
    @property
    def context(self) -> None:  # type: ignore[override]
        return None

    def handle_request(self) -> None:
        """Be another name."""


def test_a_method_of_such_a_name() -> None:
    """Its class makes no node; the line is told."""
    with pytest.raises(
        AttributeError, match=r"every node has 'handle' already: choose another name in Serving \(test_hid.*:12"
    ):
        refuse_hidden_properties(Serving, Node)


def test_other_names() -> None:
    """Properties may be replaced by others."""
    refuse_hidden_properties(Own, Node)
    refuse_hidden_properties(Node, Node)
