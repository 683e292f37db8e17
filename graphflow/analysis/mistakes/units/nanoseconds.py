"""Nanoseconds that are compared with a few seconds: `(now - self.last).nanoseconds > 0.5`, which is always true.

Also those in an integral, `self.x += self.speed * dt`, where everything else is in seconds.

Only what is seen to come from a clock counts as nanoseconds, and only numbers too small for any span of time are told.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Literal, TypeAlias

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.bindings import Bindings, bindings_of
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk

_COUNTS = ("time_ns", "monotonic_ns")
"""Functions and methods of clocks that return nanoseconds; `perf_counter_ns` may well measure a few of them."""
_SAME = ("int", "float", "abs", "round", "min", "max")
"""Functions that return a number in the unit of their argument."""
_ORDERS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
_BOUND = 1000
"""Nanoseconds below which no program measures a time."""
_MS = 50
"""Numbers from here on are milliseconds rather than seconds."""

Kind: TypeAlias = Literal["time", "duration", "nanoseconds", ""]


@cache
def compared_nanoseconds(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines that compare nanoseconds with such a number; each comes with its correction.

    Assertions and test functions are skipped: they may check that two times are almost the same.
    """
    return tuple(_compared(module))


def _compared(module: ast.Module) -> Iterator[tuple[int, str]]:
    named = (node for node in nodes_in(module) if isinstance(node, (ast.Attribute, ast.Name)))
    if not any(last_name(node) in (*_COUNTS, "nanoseconds") for node in named):
        return
    bindings = bindings_of(module)
    for node, parents in walk(module):
        if isinstance(node, ast.AugAssign):
            yield from _summed(node, bindings, parents)
        if not isinstance(node, ast.Compare) or any(map(_tests, parents)):
            continue
        sides = [node.left, *node.comparators]
        for left, order, right in zip(sides, node.ops, sides[1:], strict=False):
            for measured, limit in ((left, right), (right, left)) if isinstance(order, _ORDERS) else ():
                number = _small(limit, bindings, parents, is_exact="abs(" not in ast.unparse(measured))
                if number is None or _kind(measured, bindings, parents) != "nanoseconds":
                    continue
                # Two stamps may be the same but for a few nanoseconds.
                if isinstance(number, float) or _kind(measured, bindings, parents, has_stamps=False) == "nanoseconds":
                    yield node.lineno, _text(measured, limit, number)
                    break


def _summed(node: ast.AugAssign, bindings: Bindings, parents: Sequence[ast.AST]) -> Iterator[tuple[int, str]]:
    """Find a span in nanoseconds in the step of an integral: `self.x += self.speed * dt`."""
    match node:
        case ast.AugAssign(op=ast.Add() | ast.Sub(), value=ast.BinOp(left=left, op=ast.Mult(), right=right)):
            if not any(isinstance(part, ast.Constant) for part in nodes_in(node.value)):  # it may be the unit's factor
                for span in (left, right):
                    if _kind(span, bindings, parents) == "nanoseconds":
                        text = f"{ast.unparse(span)} is in nanoseconds; for seconds write"
                        yield node.lineno, f"{text} ({ast.unparse(span)} / 1e9)"


def _tests(parent: ast.AST) -> bool:
    return isinstance(parent, ast.Assert) or (isinstance(parent, FunctionNode) and parent.name.startswith("test"))


def _text(measured: ast.expr, limit: ast.expr, number: float) -> str:
    shown = f"{ast.unparse(measured)} is in nanoseconds, and is compared with {ast.unparse(limit)}"
    if not isinstance(limit, ast.Constant):
        return f"{shown}, which is {number}; for {number} s write {ast.unparse(limit)} * 1e9"
    milliseconds, seconds = f"for {number} ms write {number}e6", f"for {number} s write {number}e9"
    return f"{shown}; {milliseconds if isinstance(number, int) and number >= _MS else seconds}"


def _small(limit: ast.expr, bindings: Bindings, parents: Sequence[ast.AST], *, is_exact: bool) -> float | None:
    """Return a number that is too small for nanoseconds; None for any other.

    Args:
        is_exact: Whether whole numbers count, which are the tolerances of differences otherwise.
    """
    match limit:
        case ast.Constant(value=int(number)) if not isinstance(number, (bool, float)):
            return number if is_exact and 1 < number < _BOUND else None
        case ast.Constant(value=float(number)):
            return number if 0 < number < _BOUND else None
        case ast.Name() | ast.Attribute():
            values = [value.expression for value in bindings.of(limit, parents)]
            given = values[0].value if len(values) == 1 and isinstance(values[0], ast.Constant) else None
            return given if isinstance(given, float) and 0 < given < _BOUND else None
    return None


def _kind(
    expression: ast.expr, bindings: Bindings, parents: Sequence[ast.AST], depth: int = 0, *, has_stamps: bool = True
) -> Kind:
    """Return what an expression is, as far as it is seen to come from a clock.

    Args:
        depth: The number of names that have been followed.
        has_stamps: Whether the stamps of messages count.
    """
    match expression:
        case ast.Call(func=function) if last_name(function) in _COUNTS:
            return "nanoseconds"
        case ast.Call(func=ast.Attribute(value=owner, attr="now")) if "clock" in ast.unparse(owner).lower():
            return "time"
        case ast.Call(func=ast.Attribute(value=owner, attr="from_msg")) if last_name(owner) in ("Time", "Duration"):
            return "" if not has_stamps else "time" if last_name(owner) == "Time" else "duration"
        case ast.Call(func=ast.Name(id=name), args=[first, *rest]) if name in _SAME and (
            name in ("min", "max") or not rest
        ):
            return (
                "nanoseconds" if _kind(first, bindings, parents, depth, has_stamps=has_stamps) == "nanoseconds" else ""
            )
        case ast.Attribute(value=value, attr="nanoseconds"):
            return "nanoseconds" if _kind(value, bindings, parents, depth, has_stamps=has_stamps) else ""
        case ast.BinOp(left=left, op=ast.Sub(), right=right):
            kinds = {
                _kind(left, bindings, parents, depth, has_stamps=has_stamps),
                _kind(right, bindings, parents, depth, has_stamps=has_stamps),
            }
            if "nanoseconds" in kinds:
                return "nanoseconds"
            return "duration" if "time" in kinds else ""
        case ast.Name() | ast.Attribute() if depth < 4 and (isinstance(expression, ast.Name) or is_own(expression)):
            values = [v for v in bindings.of(expression, parents) if not _is_unset(v.expression)]
            kinds = {
                _kind(value, bindings, around, depth + 1, has_stamps=has_stamps) if value is not None else ""
                for value, around in values
            }
            return next(iter(kinds)) if len(kinds) == 1 else ""
    return ""


def _is_unset(value: ast.expr | None) -> bool:
    """Whether a value stands for none: `None` or 0."""
    return isinstance(value, ast.Constant) and (value.value is None or value.value in (0, 0.0))
