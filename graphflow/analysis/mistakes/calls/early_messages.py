"""Messages that an rclpy node publishes in `__init__`, before ROS 2 has found anybody who listens."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_WAITS = ("get_subscription_count", "sleep", "spin_once")
"""Calls by which a constructor may wait for listeners."""


def early_messages(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the calls of `publish` in a constructor, of publishers that keep no message for those who come later.

    Those are made there, with a plain depth for their QoS.
    """
    for cls in nodes_in(module):
        for method in cls.body if isinstance(cls, ast.ClassDef) else ():
            if isinstance(method, FunctionNode) and method.name == "__init__":
                yield from _early(method)


def _early(method: FunctionNode) -> Iterator[tuple[int, str]]:
    volatile: set[str] = set()
    for node in nodes_in(method):
        match node:
            case ast.Call(func=function) if last_name(function) in _WAITS:
                return
            case ast.Assign(targets=[target], value=ast.Call(args=[_, _, ast.Constant(value=int())]) as call):
                if is_own(target) and last_name(call.func) == "create_publisher":
                    volatile.add(target.attr)
    for statement in method.body:
        match statement:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=publisher, attr="publish"))):
                if is_own(publisher) and publisher.attr in volatile:
                    text = "in __init__, before ROS 2 has found any listener, a message is usually lost"
                    way = (
                        "publish it in a timer, or give the publisher and its subscriptions durability TRANSIENT_LOCAL"
                    )
                    yield statement.lineno, f"{text}; {way}"
