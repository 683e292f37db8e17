"""Parameters in another unit than is taken: `timeout=self.wait_ms`, or degrees for a Twist's `angular.z`."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in
from graphflow.interface import Parameter
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import ActionClient, Client, Param
from graphflow.runtime.declarations.units import contradicts, in_base_unit, is_base, is_frequency

_FIRST = {"self.clock.sleep", "self.clock.every", "self.clock.timeout", "self.create_timer"} | {
    *("asyncio.sleep", "asyncio.timeout", "time.sleep", "Duration.of")
}
"""Calls whose first argument is a time in seconds."""
_DEGREES = re.compile("deg|\N{DEGREE SIGN}")
_WAITS = ("call", "send", "send_goal", "wait_ready")
"""Methods of clients with a timeout= in seconds."""


def _as_radians(method: ast.AST) -> Iterator[ast.expr]:
    """Yield the values that are taken for radians: of sines, of a Twist's `angular`, and of keywords for angles."""
    for node in nodes_in(method):
        match node:
            case ast.Call(func=ast.Attribute(attr="sin" | "cos" | "tan"), args=[value]):
                yield value
            case ast.keyword(arg="angular", value=ast.Call(keywords=parts)):
                yield from [part.value for part in parts]
            case ast.keyword(arg="theta" | "yaw", value=value):
                yield value
            case ast.Assign(targets=[ast.Attribute(value=ast.Attribute(attr="angular"))], value=value):
                yield value


def _degrees(definition: ast.ClassDef, params: Mapping[str, Parameter]) -> Iterator[tuple[int, str]]:
    for value in _as_radians(definition):
        parameter = params.get(value.attr) if isinstance(value, ast.Attribute) and is_own(value) else None
        if parameter is not None and _DEGREES.match(parameter.unit.strip().lower()):
            name = ast.unparse(value)
            yield value.lineno, f"{name} is in {parameter.unit}, and radians are taken here; write math.radians({name})"


def wrong_units(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the lines of a class that give a parameter in another unit than is taken; each comes with a sentence."""
    declarations = declared.declarations(cls)
    params = {
        name: item.parameter for name, item in declarations.items() if isinstance(item, Param) and item.parameter.unit
    }
    yield from _degrees(definition, params)
    clients = {f"self.{name}" for name, item in declarations.items() if isinstance(item, (Client, ActionClient))}
    calls = [n for m in definition.body if params and isinstance(m, FunctionNode) for n in nodes_in(m)]
    for call in calls:
        if not isinstance(call, ast.Call):
            continue
        for word, value in _times(call, clients):
            parameter = params.get(value.attr) if isinstance(value, ast.Attribute) and is_own(value) else None
            if parameter is None or not contradicts(parameter, "Hz" if word == "hz" else "s"):
                continue
            name, method = ast.unparse(value), last_name(call.func)
            takes = f"{word}= of {method} takes" if word else f"{method} takes"
            unit = "Hz" if word == "hz" else "seconds"
            yield (
                value.lineno,
                f"{takes} {unit}, and {name} is in {parameter.unit}; write {_way(parameter, name, word, method)}",
            )


def _way(parameter: Parameter, name: str, word: str, method: str) -> str:
    """Return the correct form of the declaration or of the argument."""
    is_hz = is_frequency(parameter)
    if is_hz == (word == "hz"):
        return in_base_unit(parameter)
    other = f"{method}({name})" if word == "hz" else f"hz={name}" if method == "every" else f"1.0 / {name}"
    return other if is_base(parameter) else f"{in_base_unit(parameter)} and {other}"


def _times(call: ast.Call, clients: set[str]) -> Iterator[tuple[str, ast.expr]]:
    """List the arguments of a call that are times or frequencies, with their keywords."""
    function = ast.unparse(call.func)
    owner, _, method = function.rpartition(".")
    if function in _FIRST:
        yield from [("", value) for value in call.args[:1]]
        yield from [(k.arg, k.value) for k in call.keywords if k.arg in ("period", "seconds", "hz", "delay")]
    elif owner in clients and method in _WAITS:
        yield from [("", value) for value in call.args[:1] if method == "wait_ready"]
        yield from [(k.arg, k.value) for k in call.keywords if k.arg == "timeout"]
