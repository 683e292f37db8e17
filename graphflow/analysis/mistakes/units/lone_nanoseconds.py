"""Nanoseconds that are no seconds: `stamp.nanosec * 1e-9` starts anew in each second; `x / d.nanoseconds / 1e9`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, nodes_in


def lone_nanoseconds(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines that compute with `nanosec` in functions that never read `sec`; each comes with its correction."""
    for node in nodes_in(code):
        match node:
            case ast.BinOp(
                left=ast.BinOp(left=number, op=ast.Div(), right=ast.Attribute(attr="nanoseconds") as span),
                op=ast.Div(),
                right=factor,
            ) if _is_billion(factor):
                text = "this divides by the nanoseconds and by 1e9; in parentheses they are seconds"
                yield node.lineno, f"{text}: {ast.unparse(number)} / ({ast.unparse(span)} / 1e9)"
    for function in nodes_in(code):
        if not isinstance(function, FunctionNode):
            continue
        read = {node.attr for node in nodes_in(function) if isinstance(node, ast.Attribute)}
        if "nanosec" not in read or read & {"sec", "from_msg"}:
            continue
        for node in nodes_in(function):
            match node:
                case ast.BinOp(left=left, op=ast.Mult() | ast.Div() | ast.Sub(), right=right):
                    stamp = _stamp(left) or (_stamp(right) if isinstance(node.op, ast.Sub) else None)
                    if stamp is not None and (isinstance(node.op, ast.Sub) or _is_billion(right)):
                        name = ast.unparse(stamp)
                        text = f"{name}.nanosec is less than a second, and starts anew in each; write"
                        yield node.lineno, f"{text} {name}.sec + {name}.nanosec * 1e-9"


def _stamp(part: ast.expr) -> ast.expr | None:
    """Return the stamp whose nanoseconds an expression is, as a number or converted to one."""
    match part:
        case (
            ast.Attribute(value=stamp, attr="nanosec")
            | ast.Call(func=ast.Name(id="float" | "int"), args=[ast.Attribute(value=stamp, attr="nanosec")])
        ):
            return stamp
    return None


def _is_billion(factor: ast.expr) -> bool:
    """Whether a factor turns nanoseconds into seconds."""
    match factor:
        case ast.Constant(value=int(number) | float(number)):
            return number in (1e9, 1e-9)
        case ast.BinOp(left=ast.Constant(value=10), op=ast.Pow()):
            return ast.unparse(factor.right) in ("9", "-9")
    return False
