"""Statements without the effect meant: `self.state == "MOVE"`, where `=` was meant, and `self.ticks =+ 1`, for `+=`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import children_of

_SIGNS: dict[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
_PLACES = (ast.Name, ast.Attribute, ast.Subscript)
"""Expressions that can be assigned to."""


def ineffective(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines that consist of such an expression; each comes with its correction.

    Test functions and the bodies of `try` and `with` are skipped: the expression may be there for its error.
    """
    todo: list[tuple[ast.AST, bool]] = [(code, False)]
    while todo:
        node, is_inside = todo.pop()
        match node:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) if name.startswith("test"):
                continue
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                is_inside = True
            case ast.ClassDef():
                is_inside = False
            case ast.Expr(value=value) if is_inside and (text := _instead(value)):
                yield node.lineno, text
            case ast.Assign(targets=[target], value=ast.UnaryOp(op=ast.UAdd(), operand=step) as value) if _is_misplaced(
                target, value
            ):
                place, given = ast.unparse(target), ast.unparse(step)
                yield node.lineno, f"{place} =+ {given} sets it to {given}; write {place} += {given}"
        below = children_of(node)
        if isinstance(node, (ast.Try, ast.TryStar, ast.With, ast.AsyncWith)) and len(node.body) == 1:
            below = tuple(child for child in below if child not in node.body)
        todo += [(child, is_inside) for child in reversed(below)]


def _instead(value: ast.expr) -> str:
    match value:
        case ast.Compare(left=left, ops=[ast.Eq()]) if isinstance(left, _PLACES):
            return f"{ast.unparse(value)} compares without effect; write = to set it"
        case ast.BinOp(left=left, op=op, right=ast.Constant(value=int() | float())) if isinstance(left, _PLACES):
            sign = _SIGNS.get(type(op))
            set_ = f"{ast.unparse(left)} {sign}= {ast.unparse(value.right)}"
            return f"{ast.unparse(value)} computes without effect; write {set_}" if sign else ""
    return ""


def _is_misplaced(target: ast.expr, value: ast.UnaryOp) -> bool:
    """Whether a plus sign is written with the equals sign, and not with the number: `x =+ 1`."""
    if not isinstance(target, _PLACES) or target.end_lineno != value.lineno or value.lineno != value.operand.lineno:
        return False
    before, after = value.col_offset - (target.end_col_offset or 0), value.operand.col_offset - value.col_offset
    return before <= len(" =") and after > len("+")
