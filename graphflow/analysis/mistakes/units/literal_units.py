"""Numbers in the source that seem to be in milliseconds or degrees where seconds or radians are taken."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import pairwise

from graphflow.analysis.bindings import Bindings, bindings_of
from graphflow.analysis.mistakes.pose_names import PoseNames, pose_names
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk

_PERIODS = {"timer", "create_timer", "every", "create_rate"}
"""Functions whose first argument is a period in seconds."""
_LEAST_MS, _STEP_MS, _MINUTE = 100, 50, 60
"""Whole numbers from 100 in steps of 50 count as milliseconds, unless they are whole minutes."""
_LEAST_RATE = 10
"""Whole numbers from here to 100 count as rates in Hz where commands to a robot are published."""
_RATES = (10, 20, 25, 50)
"""Whole numbers that count as rates in Hz where any message is published."""
_ANGLES = ("rpy", "roll", "pitch", "yaw", "theta", "heading", "angle")
"""Keywords of angles in radians."""
_OF_EULER = ("quaternion_from_euler", "from_rpy", "from_euler")
_LEAST_DEGREES = 10
"""Whole numbers from here on count as degrees: in radians they would be more than a turn and a half."""
_ROUND_DEGREES = 15
"""Angular velocities count as degrees per second if they are multiples of this."""


@cache
def literal_units(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines with such numbers; each comes with a sentence."""
    found: list[tuple[int, str]] = []
    bindings, names = bindings_of(module), pose_names(module)
    for node, parents in walk(module):
        if isinstance(node, ast.Compare):
            found += _compared(node, names, parents)
        if isinstance(node, ast.Call):
            found += _of_period(node, bindings, parents)
            found += _of_angles(node)
            found += _of_sleep(node)
        found += _of_turns(node)
    return tuple(found)


def _of_period(call: ast.Call, bindings: Bindings, parents: Sequence[ast.AST]) -> Iterator[tuple[int, str]]:
    name = last_name(call.func)
    if name not in _PERIODS or name == "create_rate":
        return
    given = [
        *call.args[:1],
        *(keyword.value for keyword in call.keywords if keyword.arg in ("period", "timer_period_sec")),
    ]
    for value in given:
        bound = [found.expression for found in bindings.of(value, parents)]
        numbers = {_milliseconds(found) for found in bound or [value]}
        ms = numbers.pop()
        if ms is not None and not numbers:
            shown = f"{ast.unparse(value)} is {ms}, and " if bound else ""
            text = f"{shown}a period is in seconds: the first call comes after {ms} s"
            text += f"; if {ms} ms are meant, write {ms / 1000:g}"
            yield value.lineno, text
        rates = {_hertz(found) for found in bound or [value]}
        rate = rates.pop()
        if rate is not None and not rates and (sent := _sent(_callback(call, parents), rate)):
            shown = f"{ast.unparse(value)} is {rate}, and " if bound else ""
            way = f"@timer(hz={rate})" if name == "timer" else f"create_timer(1 / {rate}, ...)"
            text = f"{shown}a period is in seconds: {sent} comes every {rate} s"
            text += f"; if {rate} per second are meant, write {way}, else {rate}.0"
            yield value.lineno, text


def _of_sleep(call: ast.Call) -> Iterator[tuple[int, str]]:
    match call:
        case ast.Call(func=ast.Attribute(attr="sleep", value=clock), args=[value]) if last_name(clock) == "clock":
            if (ms := _milliseconds(value)) is not None:
                text = f"a sleep is in seconds, and this one takes {ms} s; if {ms} ms are meant, write {ms / 1000:g}"
                yield value.lineno, text


def _callback(call: ast.Call, parents: Sequence[ast.AST]) -> ast.AST | None:
    """Return the function that a timer calls: the decorated one, or the method of the class that is passed."""
    if parents and isinstance(parents[-1], FunctionNode) and call in parents[-1].decorator_list:
        return parents[-1]
    definition = next((node for node in reversed(parents) if isinstance(node, ast.ClassDef)), None)
    given = [*call.args[1:2], *(keyword.value for keyword in call.keywords if keyword.arg == "callback")]
    for part in definition.body if definition is not None and given else ():
        if isinstance(part, FunctionNode) and part.name == last_name(given[0]):
            return part
    return None


def _sent(function: ast.AST | None, rate: int) -> str:
    """Return what a function sends that is usually sent at such a rate; empty if it sends nothing of the kind."""
    if _commands(function):
        return "a command"
    calls = [node for node in nodes_in(function) if isinstance(node, ast.Call)] if function is not None else []
    return "a message" if rate in _RATES and any(last_name(call.func) == "publish" for call in calls) else ""


def _commands(function: ast.AST | None) -> bool:
    """Whether a function fills a Twist, which robots obey for a short time."""
    for node in nodes_in(function) if function is not None else ():
        match node:
            case ast.Call(func=callee) if last_name(callee) == "Twist":
                return True
            case ast.Assign(targets=[ast.Attribute(value=ast.Attribute(attr="linear" | "angular"))]):
                return True
    return False


def _hertz(value: ast.expr | None) -> int | None:
    """Return a whole number that is a usual rate of commands, or None."""
    match value:
        case ast.Constant(value=int(rate)) if not isinstance(rate, bool):
            return rate if _LEAST_RATE <= rate < _LEAST_MS else None
    return None


def _milliseconds(value: ast.expr | None) -> int | None:
    """Return a number that seems to be in milliseconds, or None."""
    match value:
        case ast.Constant(value=int() | float() as ms) if not isinstance(ms, bool):
            return int(ms) if ms >= _LEAST_MS and ms % _STEP_MS == 0 and ms % _MINUTE else None
    return None


def _of_angles(call: ast.Call) -> Iterator[tuple[int, str]]:
    values = [
        (keyword.arg, part) for keyword in call.keywords if keyword.arg in _ANGLES for part in _parts(keyword.value)
    ]
    if last_name(call.func) in _OF_EULER:
        values += [("an angle", value) for value in call.args]
    for name, value in values:
        number = _number(value)
        if number is not None and abs(number) >= _LEAST_DEGREES and float(number).is_integer():
            radians = math.radians(number)
            yield value.lineno, f"{name} is in radians: {number:g} degrees are {radians:.4g}, math.radians({number:g})"


def _of_turns(node: ast.AST) -> Iterator[tuple[int, str]]:
    """Find angular velocities that are a round number of degrees: in radians, they would be several turns a second."""
    match node:
        case ast.Assign(
            targets=[ast.Attribute(value=ast.Attribute(attr="angular"), attr="x" | "y" | "z")], value=value
        ):
            values = [value]
        case ast.keyword(arg="angular", value=ast.Call(keywords=keywords)):
            values = [keyword.value for keyword in keywords]
        case _:
            return
    for value in values:
        number = _number(value)
        if number is not None and abs(number) >= _LEAST_DEGREES and number % _ROUND_DEGREES == 0:
            text = f"angular velocities are in radians per second: {number:g} degrees are {math.radians(number):.4g}"
            yield value.lineno, f"{text}, math.radians({number:g})"


def _compared(comparison: ast.Compare, names: PoseNames, parents: Sequence[ast.AST]) -> Iterator[tuple[int, str]]:
    """Find comparisons of a pose's angle with a number of degrees, which it never reaches."""
    sides = [comparison.left, *comparison.comparators]
    for angle, other in (*pairwise(sides), *pairwise(reversed(sides))):
        number = _number(other)
        if number is None or abs(number) < _LEAST_DEGREES:
            continue
        match angle:
            case ast.Attribute(value=pose, attr="theta") if names.is_pose(pose, parents):
                text = f"{ast.unparse(angle)} is in radians, from -3.142 to 3.142"
                way = f"{number:g} degrees are {math.radians(number):.4g}, math.radians({number:g})"
                yield comparison.lineno, f"{text}: {way}"


def _parts(value: ast.expr) -> list[ast.expr]:
    return list(value.elts) if isinstance(value, (ast.Tuple, ast.List)) else [value]


def _number(value: ast.expr) -> float | None:
    match value:
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(number) | float(number))):
            return -number
        case ast.Constant(value=int(number) | float(number)) if not isinstance(number, bool):
            return number
    return None
