"""Comparisons that hold by chance alone: a measured position, compared with a number by `==`."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache

from graphflow.analysis.bindings import Bindings
from graphflow.analysis.mistakes.pose_names import PoseNames, pose_names
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk


@cache
def never_exact(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines that compare a turtlesim pose's place with a number by `==`; each comes with its correction.

    Zero is skipped, and a file that teleports turtles, to places that are exact. Tests may compare exactly, too.
    """
    return tuple(_exact(module))


def _exact(module: ast.Module) -> Iterator[tuple[int, str]]:
    names = pose_names(module)
    if not names.poses:
        return
    words = {last_name(node) for node in nodes_in(module) if isinstance(node, (ast.Name, ast.Attribute))}
    if any("teleport" in word.lower() for word in words):
        return
    for node, parents in walk(module):
        match node:
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as op], comparators=[right]):
                if any(isinstance(p, ast.Assert) or _is_test(p) for p in parents):
                    continue
                for measured, wanted in ((left, right), (right, left)):
                    if _is_place(measured, names, parents) and _is_number(wanted, names.bindings, parents):
                        shown, number = ast.unparse(measured), ast.unparse(wanted)
                        sign = "<" if isinstance(op, ast.Eq) else ">"
                        text = f"{shown} is hardly ever exactly {number}"
                        yield node.lineno, f"{text}; write abs({shown} - {number}) {sign} 0.1, with a tolerance"


def _is_test(parent: ast.AST) -> bool:
    return isinstance(parent, FunctionNode) and parent.name.startswith("test")


def _is_place(expression: ast.expr, names: PoseNames, parents: list[ast.AST]) -> bool:
    return (
        isinstance(expression, ast.Attribute)
        and expression.attr in ("x", "y", "theta")
        and names.is_pose(expression.value, parents)
    )


def _is_number(expression: ast.expr, bindings: Bindings, parents: Sequence[ast.AST]) -> bool:
    """Whether an expression is a number but zero, a parameter, or a name that is bound to such alone."""
    match expression:
        case ast.Constant(value=value):
            return isinstance(value, (int, float)) and not isinstance(value, bool) and value != 0
        case ast.Call(func=function):
            return last_name(function) == "Param"
        case ast.Name() | ast.Attribute():
            values = [value.expression for value in bindings.of(expression, parents)]
            return bool(values) and all(
                isinstance(v, (ast.Constant, ast.Call)) and _is_number(v, bindings, parents) for v in values
            )
    return False
