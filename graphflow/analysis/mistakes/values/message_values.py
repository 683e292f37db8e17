"""Messages that are taken for their values: `if msg == "go":` and `if msg:` in the callback of a subscription.

Likewise the values that are taken for others: `if msg.data == 5:` of a String.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_NUMBERS = {f"{sign}Int{size}" for sign in ("", "U") for size in (8, 16, 32, 64)} | {"Float32", "Float64"}
"""The types of `std_msgs` whose `data` is a number."""


def message_values(code: ast.AST, callbacks: Mapping[str, str]) -> Iterator[tuple[int, str]]:
    """Find the lines that compare or test the message of a callback; each comes with its correction.

    Args:
        callbacks: The methods that receive messages, each with the name of the type, such as "String".
    """
    for method in nodes_in(code):
        if not isinstance(method, FunctionNode) or method.name not in callbacks or len(method.args.args) != 2:
            continue
        name = method.args.args[1].arg
        if any(isinstance(n, ast.Name) and n.id == name and isinstance(n.ctx, ast.Store) for n in nodes_in(method)):
            continue
        way, kind = f"write {name}.data, or another field", callbacks[method.name]
        for node in nodes_in(method):
            match node:
                case ast.Compare(
                    left=ast.Name(id=used), comparators=[ast.Constant(value=str() | int() | float() as v)]
                ):
                    if used == name:
                        yield node.lineno, f"{name} is a message, which never equals {v!r}; {way}"
                case ast.Compare(
                    left=ast.Attribute(value=ast.Name(id=used), attr="data"),
                    ops=[ast.Eq() | ast.NotEq()],
                    comparators=[ast.Constant(value=v)],
                ) if used == name and (text := _never_equal(f"{name}.data", kind, v)):
                    yield node.lineno, text
                case ast.If(test=test) | ast.IfExp(test=test) | ast.While(test=test):
                    bare = test.operand if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) else test
                    if isinstance(bare, ast.Name) and bare.id == name:
                        yield test.lineno, f"{name} is a message, and so always true; {way}"


def _never_equal(shown: str, kind: str, value: object) -> str:
    """Return a sentence if the `data` of a message of `std_msgs` never equals a constant; "" if it may."""
    if kind == "String" and isinstance(value, (int, float)):
        return f"{shown} is a text, which never equals {value!r}; write {str(value)!r}, or convert it"
    if kind == "Bool" and isinstance(value, str):
        return f"{shown} is a bool, which never equals {value!r}; write True or False, without quotes"
    if kind in _NUMBERS and isinstance(value, str):
        return f"{shown} is a number, which never equals {value!r}; write it without quotes"
    return ""


def subscribed(module: ast.AST) -> dict[str, str]:
    """Return the methods that a program for rclpy subscribes, each with the name of the type."""
    calls = (node for node in nodes_in(module) if isinstance(node, ast.Call))
    return {
        last_name(call.args[2]): last_name(call.args[0])
        for call in calls
        if last_name(call.func) == "create_subscription" and len(call.args) > 2
    }
