"""Methods of an rclpy node that replace one which rclpy itself calls, such as `def declare_parameters(self):`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_BASES = ("Node", "LifecycleNode")
_CALLED = {"declare_parameter", "declare_parameters", "get_parameter", "get_parameters", "has_parameter"}
_CALLED |= {"set_parameters", "set_parameters_atomically", "describe_parameters", "get_name", "get_namespace"}
_CALLED |= {"get_fully_qualified_name", "get_clock", "get_logger", "create_publisher", "create_subscription"}
_CALLED |= {"create_service", "create_client", "add_waitable"}
"""Methods that rclpy's nodes, executors, actions and parameter services call."""


def hidden_methods(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines of such methods, unless they call the one that they replace; each comes with a sentence."""
    for cls in nodes_in(module):
        if isinstance(cls, ast.ClassDef) and any(last_name(base) in _BASES for base in cls.bases):
            for method in cls.body:
                if isinstance(method, FunctionNode) and method.name in _CALLED and not _calls_parents(method):
                    text = f"{cls.name}.{method.name} replaces a method that rclpy itself calls, and ROS 2 then fails"
                    yield method.lineno, f"{text}: choose another name"


def _calls_parents(method: FunctionNode) -> bool:
    """Whether a method calls the one that it replaces, by `super()` or by the name of its class."""
    calls = (node.func for node in nodes_in(method) if isinstance(node, ast.Call))
    return any(
        isinstance(function, ast.Attribute) and function.attr == method.name and ast.unparse(function.value) != "self"
        for function in calls
    )
