"""Degrees that are mixed with radians: `math.degrees(math.atan2(dy, dx)) - pose.theta`.

An angle counts as one or the other only if a function of `math` or NumPy returns it, if it is a parameter declared
with that unit, or if it is a turtlesim pose's.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Literal, TypeAlias

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.mistakes.pose_names import DEPTH, PoseNames, pose_names
from graphflow.analysis.syntax import last_name, nodes_in, walk

_DEGREES = ("degrees", "rad2deg")
_RADIANS = ("radians", "deg2rad")
_INVERSE = ("atan2", "atan", "asin", "acos", "arctan2", "arctan", "arcsin", "arccos")
_TAKING_RADIANS = ("sin", "cos", "tan")
_SAME = ("abs", "float")

Unit: TypeAlias = Literal["degrees", "radians", ""]
_UNITS: dict[str, Unit] = {"deg": "degrees", "rad": "radians"}
"""The units of parameters."""


@cache
def mixed_angles(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines that add, subtract or compare such angles, or take a sine of degrees; each with a correction."""
    return tuple(_mixed(module, pose_names(module))) if _has_conversions(module) else ()


def _has_conversions(module: ast.Module) -> bool:
    """Whether a file mentions degrees or conversions at all; most do not."""
    for node in nodes_in(module):
        match node:
            case ast.Attribute(attr=name) | ast.Name(id=name) | ast.Constant(value=str(name)):
                if name in (*_DEGREES, *_RADIANS) or _UNITS.get(name) == "degrees":
                    return True
    return False


def _mixed(module: ast.Module, names: PoseNames) -> Iterator[tuple[int, str]]:
    for node, parents in walk(module):
        if isinstance(node, ast.Call) and len(node.args) == 1:
            yield from _misconverted(node, names, parents)
        for left, right in _pairs(node):
            units = {_unit(side, names, parents): side for side in (left, right)}
            if units.keys() == {"degrees", "radians"}:
                degrees, radians = (ast.unparse(units[unit]) for unit in ("degrees", "radians"))
                is_plain = isinstance(units["degrees"], (ast.Name, ast.Attribute))
                way = f"write math.radians({degrees})" if is_plain else "write both in radians"
                yield left.lineno, f"{degrees} is in degrees, and {radians} in radians; {way}"


def _pairs(node: ast.AST) -> list[tuple[ast.expr, ast.expr]]:
    """Return the expressions whose units have to agree."""
    match node:
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            return [(left, right)]
        case ast.AugAssign(target=target, op=ast.Add() | ast.Sub(), value=value):
            return [(target, value)]
        case ast.Compare(left=left, comparators=others):
            return [*zip([left, *others], others, strict=False)]
    return []


def _misconverted(call: ast.Call, names: PoseNames, parents: Sequence[ast.AST]) -> Iterator[tuple[int, str]]:
    """Find a sine of degrees, and an angle that is converted to the unit that it has."""
    name, angle = names.called(call.func), call.args[0]
    if name in _TAKING_RADIANS and _unit(angle, names, parents) == "degrees":
        yield call.lineno, f"{ast.unparse(angle)} is in degrees, and {name} takes radians"
    wanted = "degrees" if name in _DEGREES else "radians"
    if name in (*_DEGREES, *_RADIANS) and _unit(angle, names, parents) == wanted:
        yield call.lineno, f"{ast.unparse(angle)} is in {wanted} already: leave out {ast.unparse(call.func)}"


def _unit(expression: ast.expr, names: PoseNames, parents: Sequence[ast.AST], depth: int = 0) -> Unit:
    """Return the unit of an angle; empty if it is not seen.

    Args:
        depth: The number of names that have been followed.
    """
    match expression:
        case ast.Call(func=function) if (name := names.called(function)) in (*_DEGREES, *_RADIANS, *_INVERSE):
            return "degrees" if name in _DEGREES else "radians"
        case ast.Call(func=function) if last_name(function) == "Param":
            given = [
                k.value.value for k in expression.keywords if k.arg == "unit" and isinstance(k.value, ast.Constant)
            ]
            return _UNITS.get(str(given[0]), "") if given else ""
        case ast.Call(func=ast.Name(id=name), args=[angle]) if name in _SAME:
            return _unit(angle, names, parents, depth)
        case ast.UnaryOp(op=ast.USub(), operand=angle):
            return _unit(angle, names, parents, depth)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            units = {_unit(left, names, parents, depth), _unit(right, names, parents, depth)} - {""}
            return next(iter(units)) if len(units) == 1 else ""
        case ast.Attribute(value=pose, attr="theta") if names.is_pose(pose, parents):
            return "radians"
        case ast.Name() | ast.Attribute() if depth < DEPTH and (isinstance(expression, ast.Name) or is_own(expression)):
            values = [v for v in names.bindings.of(expression, parents) if not _is_zero(v.expression)]
            units = {_unit(v, names, around, depth + 1) if v is not None else "" for v, around in values}
            return next(iter(units)) if len(units) == 1 else ""
    return ""


def _is_zero(value: ast.expr | None) -> bool:
    """Whether a value stands for none: `None` or 0."""
    return isinstance(value, ast.Constant) and (value.value is None or value.value in (0, 0.0))
