"""Messages that are taken for their values: `if msg == "go":` and `if msg:` in the callback of a subscription."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in


def message_values(code: ast.AST, callbacks: Collection[str]) -> Iterator[tuple[int, str]]:
    """Find the lines that compare or test the message of a callback; each comes with its correction.

    Args:
        callbacks: The methods that receive messages.
    """
    for method in nodes_in(code):
        if not isinstance(method, FunctionNode) or method.name not in callbacks or len(method.args.args) != 2:
            continue
        name = method.args.args[1].arg
        if any(isinstance(n, ast.Name) and n.id == name and isinstance(n.ctx, ast.Store) for n in nodes_in(method)):
            continue
        way = f"write {name}.data, or another field"
        for node in nodes_in(method):
            match node:
                case ast.Compare(
                    left=ast.Name(id=used), comparators=[ast.Constant(value=str() | int() | float() as v)]
                ):
                    if used == name:
                        yield node.lineno, f"{name} is a message, which never equals {v!r}; {way}"
                case ast.If(test=test) | ast.IfExp(test=test) | ast.While(test=test):
                    bare = test.operand if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) else test
                    if isinstance(bare, ast.Name) and bare.id == name:
                        yield test.lineno, f"{name} is a message, and so always true; {way}"


def subscribed(module: ast.AST) -> set[str]:
    """Return the methods that a program for rclpy subscribes."""
    calls = (node for node in nodes_in(module) if isinstance(node, ast.Call))
    return {
        last_name(call.args[2])
        for call in calls
        if last_name(call.func) == "create_subscription" and len(call.args) > 2
    }
