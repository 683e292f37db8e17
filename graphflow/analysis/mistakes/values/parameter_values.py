"""Comparisons of rclpy's parameters that never hold: of a Parameter itself, or of a value with another type's.

Likewise of the status of a goal, which is a number, with its name.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from graphflow.analysis.bindings import Bindings, bindings_of
from graphflow.analysis.syntax import last_name, nodes_in, walk

_KINDS = {bool: "a bool", int: "an integer", float: "a double", str: "a text"}
_STATES = ("SUCCEEDED", "ABORTED", "CANCELED", "CANCELING", "EXECUTING", "ACCEPTED", "UNKNOWN")


def parameter_values(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines with such a comparison, or with a Parameter as a condition; each comes with its correction."""
    declared, bindings = _declared(module), bindings_of(module)
    for node, parents in walk(module):
        match node:
            case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
                bare = test.operand if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) else test
                if _read(bare, [*parents, node], bindings):
                    shown = ast.unparse(bare)
                    yield test.lineno, f"{shown} is a Parameter, and so always true; write {shown}.value"
            case ast.Compare(
                left=left,
                ops=[ast.Eq() | ast.NotEq() | ast.Is() | ast.IsNot()],
                comparators=[ast.Constant(value=bool() | int() | float() | str() as wanted)],
            ):
                shown = ast.unparse(left)
                if _read(left, parents, bindings):
                    yield node.lineno, f"{shown} is a Parameter, which never equals {wanted!r}; write {shown}.value"
                elif text := _of_value(left, wanted, declared, parents, bindings) or _of_status(left, wanted):
                    yield node.lineno, text


def _read(expression: ast.expr, parents: Sequence[ast.AST], bindings: Bindings) -> str:
    """Return the name of the parameter that an expression is, as `get_parameter` returns it; "" for any other."""
    match expression:
        case ast.Call(func=function, args=[ast.Constant(value=str(name))]) if last_name(function) == "get_parameter":
            return name
        case ast.Name():
            values = [value.expression for value in bindings.of(expression, parents)]
            names = {_read(v, parents, bindings) if isinstance(v, ast.Call) else "" for v in values}
            return names.pop() if len(names) == 1 else ""
    return ""


def _of_value(
    read: ast.expr, wanted: object, declared: Mapping[str, object], parents: Sequence[ast.AST], bindings: Bindings
) -> str:
    """Return a sentence if the value of a parameter is compared with one of another type."""
    match read:
        case ast.Attribute(value=ast.Call() | ast.Name() as parameter, attr="value"):
            name = _read(parameter, parents, bindings)
        case _:
            return ""
    default = declared.get(name)
    is_number = isinstance(default, (int, float)) and isinstance(wanted, (int, float))
    if default is None or is_number or type(default) is type(wanted):
        return ""
    text = f"{ast.unparse(read)} is {_KINDS[type(default)]}, as it is declared, and never {wanted!r}"
    if isinstance(wanted, bool):
        return f"{text}; declare it as declare_parameter({name!r}, {wanted})"
    return f"{text}; compare it with {_KINDS[type(default)]}"


def _of_status(read: ast.expr, wanted: object) -> str:
    if isinstance(read, ast.Attribute) and read.attr == "status" and wanted in _STATES:
        return f"{ast.unparse(read)} is a number; write GoalStatus.STATUS_{wanted}, from action_msgs.msg"
    return ""


def _declared(module: ast.Module) -> dict[str, object]:
    """Return the defaults of the parameters that a file declares once, by name; None for others."""
    found: dict[str, object] = {}
    for node in nodes_in(module):
        match node:
            case ast.Call(func=function, args=[ast.Constant(value=str(name)), default, *_]) if (
                last_name(function) == "declare_parameter"
            ):
                value = default.value if isinstance(default, ast.Constant) and type(default.value) in _KINDS else None
                found[name] = None if name in found else value
    return found
