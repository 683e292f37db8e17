"""Conditions that contradict each other, `x > 9.0 and x < 2.0`, or leave nothing out, `x > 2.0 or x < 9.0`."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

from graphflow.analysis.syntax import nodes_in


class _Bound(NamedTuple):
    """A condition that bounds a value by a number."""

    value: str
    is_lower: bool
    number: float
    condition: ast.expr


def contrary_bounds(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines with such conditions; each comes with the word that was meant."""
    for node in nodes_in(module):
        if isinstance(node, ast.BoolOp):
            word, always, meant = ("and", "never", "or") if isinstance(node.op, ast.And) else ("or", "always", "and")
            bounds = [bound for condition in node.values if (bound := _bound(condition)) is not None]
            for one, other in combinations(bounds, 2):
                if _is_contrary(one, other, word):
                    text = f"{ast.unparse(one.condition)} {word} {ast.unparse(other.condition)}"
                    yield one.condition.lineno, f"{text} is {always} true; did you mean {meant}?"
                    break


def _bound(condition: ast.expr) -> _Bound | None:
    match condition:
        case ast.Compare(
            left=value,
            ops=[ast.Gt() | ast.GtE() | ast.Lt() | ast.LtE() as op],
            comparators=[ast.Constant(value=int() | float() as number)],
        ) if not any(isinstance(part, ast.Call) for part in nodes_in(value)):  # which may return another value
            return _Bound(ast.unparse(value), isinstance(op, (ast.Gt, ast.GtE)), number, condition)
    return None


def _is_contrary(one: _Bound, other: _Bound, word: str) -> bool:
    if one.value != other.value or one.is_lower == other.is_lower:
        return False
    lower, upper = (one.number, other.number) if one.is_lower else (other.number, one.number)
    return lower > upper if word == "and" else lower < upper
