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
from graphflow.analysis.bindings import Bindings, bindings_of
from graphflow.analysis.syntax import FunctionNode, last_name, walk

_DEGREES = ("degrees", "rad2deg")
_RADIANS = ("radians", "deg2rad")
_INVERSE = ("atan2", "atan", "asin", "acos", "arctan2", "arctan", "arcsin", "arccos")
_TAKING_RADIANS = ("sin", "cos", "tan")
_LIBRARIES = ("math", "np", "numpy")
_SAME = ("abs", "float")

Unit: TypeAlias = Literal["degrees", "radians", ""]
_UNITS: dict[str, Unit] = {"deg": "degrees", "rad": "radians"}
"""The units of parameters."""


@cache
def mixed_angles(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines that add, subtract or compare such angles, or take a sine of degrees; each with a correction."""
    names = pose_names(module)
    return tuple(_mixed(module, names)) if names.has_degrees else ()


class PoseNames:
    """The imports of a file, the bindings of its names, and which of these are turtlesim poses."""

    def __init__(self, module: ast.Module) -> None:
        self.bindings: Bindings = bindings_of(module)
        self.functions: set[str] = set()
        """Functions of `math` and NumPy that are imported by name."""
        self.poses: set[str] = set()
        """Names of turtlesim's Pose."""
        self.has_degrees = False
        has_own_theta = False
        for node in ast.walk(module):
            match node:
                case ast.ImportFrom(module=str(path), names=names) if path in _LIBRARIES:
                    self.functions |= {alias.name for alias in names if alias.asname is None}
                case ast.ImportFrom(module=str(path), names=names) if path.endswith("turtlesim.msg"):
                    self.poses |= {alias.asname or alias.name for alias in names if alias.name == "Pose"}
                case ast.Attribute(attr="theta", ctx=ast.Store()):
                    has_own_theta = True
                case ast.Attribute(attr=name) | ast.Name(id=name) | ast.Constant(value=str(name)) if (
                    name in _DEGREES or _UNITS.get(name) == "degrees"
                ):
                    self.has_degrees = True
        if has_own_theta:
            self.poses = set()  # somebody may keep degrees there
        self.callbacks: set[str] = set()
        """Methods that are passed to `create_subscription` for such poses."""
        for node in ast.walk(module) if self.poses else ():
            match node:
                case ast.Call(func=ast.Attribute(attr="create_subscription"), args=[type_, _, callback, *_]):
                    self.callbacks |= {last_name(callback)} if last_name(type_) in self.poses else set()

    def called(self, function: ast.expr) -> str:
        """Return the name of a function of `math` or NumPy; empty for any other."""
        match function:
            case ast.Attribute(value=ast.Name(id=library), attr=name) if library in _LIBRARIES:
                return name
            case ast.Name(id=name) if name in self.functions:
                return name
        return ""

    def is_pose(self, expression: ast.expr, parents: Sequence[ast.AST], depth: int = 0) -> bool:
        """Whether an expression is a turtlesim pose that a handler received, or an attribute that keeps one."""
        if not self.poses or not isinstance(expression, (ast.Name, ast.Attribute)):
            return False
        if isinstance(expression, ast.Name):
            function = next((p for p in reversed(parents) if isinstance(p, FunctionNode)), None)
            argument = next((a for a in function.args.args if a.arg == expression.id), None) if function else None
            if function is not None and argument is not None:
                return self._receives(function, argument)
        values = [v for v in self.bindings.of(expression, parents) if not _is_none(v.expression)]
        return (
            bool(values)
            and depth < _DEPTH
            and all(
                value is not None and (self._makes(value) or self.is_pose(value, around, depth + 1))
                for value, around in values
            )
        )

    def _makes(self, value: ast.expr) -> bool:
        return isinstance(value, ast.Call) and last_name(value.func) in self.poses

    def _receives(self, function: FunctionNode, argument: ast.arg) -> bool:
        if argument.annotation is not None:
            return last_name(argument.annotation) in self.poses
        if function.name in self.callbacks:
            return True
        calls = [decorator for decorator in function.decorator_list if isinstance(decorator, ast.Call)]
        return any(
            last_name(call.func) == "subscription" and bool(call.args) and last_name(call.args[0]) in self.poses
            for call in calls
        )


@cache
def pose_names(module: ast.Module) -> PoseNames:
    """Return the names of a module, collected once."""
    return PoseNames(module)


_DEPTH = 4
"""The number of names that are followed to a value."""


def _mixed(module: ast.Module, names: PoseNames) -> Iterator[tuple[int, str]]:
    for node, parents in walk(module):
        pairs: list[tuple[ast.expr, ast.expr]] = []
        match node:
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
                pairs = [(left, right)]
            case ast.AugAssign(target=target, op=ast.Add() | ast.Sub(), value=value):
                pairs = [(target, value)]
            case ast.Compare(left=left, comparators=others):
                pairs = [*zip([left, *others], others, strict=False)]
            case ast.Call(func=function, args=[angle]) if names.called(function) in _TAKING_RADIANS:
                if _unit(angle, names, parents) == "degrees":
                    name = names.called(function)
                    yield node.lineno, f"{ast.unparse(angle)} is in degrees, and {name} takes radians"
        line = getattr(node, "lineno", 0)
        for left, right in pairs:
            units = {_unit(side, names, parents): side for side in (left, right)}
            if units.keys() == {"degrees", "radians"}:
                degrees, radians = (ast.unparse(units[unit]) for unit in ("degrees", "radians"))
                is_plain = isinstance(units["degrees"], (ast.Name, ast.Attribute))
                way = f"write math.radians({degrees})" if is_plain else "write both in radians"
                yield line, f"{degrees} is in degrees, and {radians} in radians; {way}"


def _unit(expression: ast.expr, names: PoseNames, parents: Sequence[ast.AST], depth: int = 0) -> Unit:
    """Return the unit of an angle; empty if it is not seen.

    Args:
        depth: The number of names that have been followed.
    """
    match expression:
        case ast.Call(func=function) if (name := names.called(function)) in (*_DEGREES, *_RADIANS, *_INVERSE):
            is_named = any(keyword.arg == "deg" for keyword in expression.keywords)
            return "" if is_named else "degrees" if name in _DEGREES else "radians"
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
        case ast.Name() | ast.Attribute() if depth < _DEPTH and (
            isinstance(expression, ast.Name) or is_own(expression)
        ):
            values = [v for v in names.bindings.of(expression, parents) if not _is_zero(v.expression)]
            units = {_unit(v, names, around, depth + 1) if v is not None else "" for v, around in values}
            return next(iter(units)) if len(units) == 1 else ""
    return ""


def _is_none(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Constant) and value.value is None


def _is_zero(value: ast.expr | None) -> bool:
    """Whether a value stands for none: `None` or 0."""
    return isinstance(value, ast.Constant) and (value.value is None or value.value in (0, 0.0))
