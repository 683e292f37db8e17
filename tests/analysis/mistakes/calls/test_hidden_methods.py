"""Methods that replace rclpy's own."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.hidden_methods import hidden_methods

CLASS = "class Robot({base}):\n    def {name}(self, *args):\n        {body}\n"


def _told(base: str = "Node", name: str = "declare_parameters", body: str = "pass") -> list[tuple[int, str]]:
    return list(hidden_methods(ast.parse(CLASS.format(base=base, name=name, body=body))))


@pytest.mark.parametrize("name", ["declare_parameters", "get_parameters", "get_name", "create_publisher"])
@pytest.mark.parametrize("base", ["Node", "rclpy.node.Node", "LifecycleNode"])
def test_a_method_of_every_node(base: str, name: str) -> None:
    """It is told with its line, also if it calls itself."""
    text = f"Robot.{name} replaces a method that rclpy itself calls, and ROS 2 then fails: choose another name"
    assert _told(base, name) == [(2, text)]
    assert _told(base, name, f"self.{name}()") == [(2, text)]


@pytest.mark.parametrize(
    ("base", "name", "body"),
    [
        ("Node", "declare_parameters", "return super().declare_parameters(*args)"),
        ("Node", "get_name", "return Node.get_name(self)"),
        ("Node", "destroy_node", "pass"),
        ("Node", "read_parameters", "pass"),
        ("Driver", "get_name", "pass"),
    ],
)
def test_other_methods(base: str, name: str, body: str) -> None:
    """They extend what they replace, or have names of their own, or are of a class of another kind."""
    assert _told(base, name, body) == []
