"""Values that contradict their own names: `create_timer(rate, ...)`, which takes a period, and `atan2(dx, dy)`."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from functools import cache

from graphflow.analysis.bindings import Bindings, bindings_of
from graphflow.analysis.syntax import last_name, nodes_in, walk

_MILLISECONDS = re.compile(r"(?i)(.*_)?(ms|msec|msecs|millis|milliseconds)")
_FREQUENCIES = re.compile(r"(?i)(.*_)?(hz|hertz|rate|freq|frequency|fps)")
_SLEEPING = ("time.sleep", "asyncio.sleep", "self.clock.sleep", "clock.sleep")
_GIVEN = ("get_parameter", "declare_parameter")
"""rclpy's methods that return parameters."""
_IN_X = re.compile(r"(?<![a-zA-Z])(d|diff|delta|err|error)?x(?![a-zA-Z])")
"""The letter x as a name, or as a part of one: `dx`, `goal_x`, `goal.x`."""
_FROM_NORTH = re.compile(r"(?i)azimuth|bearing|compass|north|navsatfix|latitude")
"""Words of files that count angles from north, where atan2(dx, dy) is right."""


@cache
def contrary_names(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines that give such a value; each comes with its correction."""
    return tuple(_contrary(module))


def _contrary(module: ast.Module) -> Iterator[tuple[int, str]]:
    bindings = bindings_of(module)
    calls = [(node, parents) for node, parents in walk(module) if isinstance(node, ast.Call)]
    for call, parents in calls:
        for value in _seconds(call):
            name, function = ast.unparse(value), ast.unparse(call.func).removeprefix("self.")
            if _MILLISECONDS.fullmatch(last_name(value)) and _may_be_large(value, bindings, parents):
                text = f"{function} takes seconds, and {name} is in milliseconds by its name"
                yield value.lineno, f"{text}; write {name} / 1000"
            elif _FREQUENCIES.fullmatch(last_name(value)) and _may_be_large(value, bindings, parents, above=1):
                is_param = function == "timer" and isinstance(value, ast.Name)
                text = f"{function} takes seconds, and {name} is a frequency by its name"
                yield value.lineno, f"{text}; write {f'@timer(hz={name})' if is_param else f'1 / {name}'}"
    swapped = [(call, parents) for call, parents in calls if _is_swapped(call)]
    if swapped and _turns_from_x(module):
        for call, parents in swapped:
            if not any(isinstance(parent, ast.BinOp) and _is_quarter(parent) for parent in parents):
                first, second = (ast.unparse(argument) for argument in call.args)
                text = f"{ast.unparse(call)} counts from the y axis; atan2 takes y first"
                yield call.lineno, f"{text}: write {ast.unparse(call.func)}({second}, {first})"


def _seconds(call: ast.Call) -> list[ast.expr]:
    """Return the arguments of a call that are a period or a time in seconds."""
    is_timer = last_name(call.func) == "create_timer" and isinstance(call.func, ast.Attribute)
    is_timer = is_timer or (isinstance(call.func, ast.Name) and call.func.id == "timer")  # the decorator
    named = [k.value for k in call.keywords if is_timer and k.arg in ("timer_period_sec", "period")]
    return [*call.args[:1], *named] if is_timer or ast.unparse(call.func) in _SLEEPING else []


def _may_be_large(value: ast.expr, bindings: Bindings, parents: Sequence[ast.AST], above: float = 0.99) -> bool:
    """Whether a name is bound to numbers above a bound, or to parameters; false if that is not seen."""
    found = bindings.of(value, parents)
    if not found and isinstance(value, ast.Name):  # in a decorator, a name of the class's body
        found = bindings.of(ast.Attribute(ast.Name("self"), value.id), parents)
    return bool(found) and all(v.expression is not None and _is_large(v.expression, above) for v in found)


def _is_large(value: ast.expr, above: float) -> bool:
    match value:
        case ast.Constant(value=number):
            return isinstance(number, (int, float)) and number > above
        case ast.Call(func=function, args=[first, *_], keywords=keywords) if last_name(function) == "Param":
            # `wrong_units` judges those with a unit.
            return _is_large(first, above) and not any(keyword.arg == "unit" for keyword in keywords)
        case ast.Call(func=function, args=[_, default, *_]) if last_name(function) == "declare_parameter":
            return _is_large(default, above)
        case ast.Call(func=function) if last_name(function) in _GIVEN:
            return True
        case ast.Attribute(value=inner, attr="value"):
            return _is_large(inner, above)
    return False


def _is_swapped(call: ast.Call) -> bool:
    """Whether a call is `atan2(dx, dy)`, or of other names that differ in x and y alone."""
    if last_name(call.func) not in ("atan2", "arctan2") or len(call.args) != 2:
        return False
    first, second = (ast.unparse(argument) for argument in call.args)
    return first != second and _IN_X.sub(lambda found: found[0][:-1] + "y", first) == second


def _turns_from_x(module: ast.Module) -> bool:
    """Whether a file subtracts an angle that counts from the x axis, as a pose's, and has none from north."""
    words = {last_name(node) for node in nodes_in(module) if isinstance(node, (ast.Name, ast.Attribute))}
    taken = [n.right for n in nodes_in(module) if isinstance(n, ast.BinOp) and isinstance(n.op, ast.Sub)]
    return any(last_name(n) in ("theta", "yaw") for n in taken) and not any(map(_FROM_NORTH.search, words))


def _is_quarter(term: ast.BinOp) -> bool:
    """Whether a sum has a right angle in it, which turns the one axis into the other."""
    return any(
        last_name(node) == "pi" or (isinstance(node, ast.Constant) and node.value in (90, 1.57, 1.5708))
        for node in nodes_in(term)
        if isinstance(node, ast.expr)
    )
