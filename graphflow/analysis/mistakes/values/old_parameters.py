"""Callbacks for new parameter values that read the old ones: rclpy calls them before the parameter changes."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in


def old_parameters(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines of such callbacks that keep what `get_parameter` returns; each comes with its correction."""
    names = {
        last_name(call.args[0])
        for call in nodes_in(module)
        if isinstance(call, ast.Call) and last_name(call.func) == "add_on_set_parameters_callback" and call.args
    }
    for method in nodes_in(module):
        if not isinstance(method, FunctionNode) or method.name not in names or len(method.args.args) < 2:
            continue
        given = method.args.args[1].arg
        for node in nodes_in(method):
            match node:
                case ast.Assign(targets=[ast.Attribute() as target], value=value) if is_own(target) and _reads(value):
                    text = "get_parameter returns the old value until this callback has accepted the new one; read the"
                    way = f"new ones from {given}: for parameter in {given}: parameter.name, parameter.value"
                    yield node.lineno, f"{text} {way}"


def _reads(value: ast.expr) -> bool:
    """Whether an expression is the value of a parameter of the node."""
    return any(
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr == "get_parameter"
        and last_name(node.func.value) == "self"
        for node in nodes_in(value)
    )
