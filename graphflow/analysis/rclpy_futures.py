"""Futures of rclpy's clients in a method: the names that it has for them, and the loops that ask for their end."""

from __future__ import annotations

import ast
import re
from collections.abc import Container, Iterator
from typing import NamedTuple

from graphflow.analysis.syntax import is_nested, last_name, nodes_in, walk

SPINS = ("rclpy.spin_until_future_complete", "rclpy.spin_once", "rclpy.spin")
"""Functions that spin a node until a future is done, or for a while."""
BLOCKS = ast.Module | ast.FunctionDef | ast.AsyncFunctionDef | ast.If | ast.For | ast.While | ast.With | ast.Try
"""Statements with a body."""
_LOOKS = ("spin_until_future_complete", "spin_once_until_future_complete", "print")
"""Functions that read a future, and do not end it."""
_ASKING = ("call_async", "send_goal_async")
"""Methods of clients that return futures."""
_WAITING = re.compile(r"spin|done|wait|sleep|join|event")
"""Words in the names of functions after which a future may have its result."""


def futures_of(function: ast.AST, clients: Container[str]) -> dict[str, str]:
    """Return the names of futures that a function gets from clients, each with the client."""
    found = {}
    for node in nodes_in(function):
        match node:
            case ast.Assign(
                targets=[target],
                value=ast.Call(func=ast.Attribute(value=ast.Attribute(value=ast.Name("self"), attr=name), attr=verb)),
            ) if name in clients and verb in _ASKING:
                if not _is_known_elsewhere(dotted(target), function):
                    found[dotted(target)] = name
    return found


def _is_known_elsewhere(future: str, function: ast.AST) -> bool:
    """Whether a function passes a future to other code, which may end it, or ends it itself."""
    for node, parents in walk(function):
        is_use = isinstance(node, (ast.Name, ast.Attribute)) and isinstance(node.ctx, ast.Load)
        if not (is_use and parents and isinstance(node, ast.expr) and dotted(node) == future):
            continue
        if is_nested(parents):  # an inner function runs at any time
            return True
        match parents[-1]:
            case ast.Attribute(attr=attr) if attr not in ("cancel", "set_result", "set_exception"):
                continue
            case ast.Await() | ast.Expr():
                continue
            case ast.Call(func=called) if ast.unparse(called) in SPINS or last_name(called) in _LOOKS:
                continue
        return True
    return False


def polled_futures(test: ast.expr) -> Iterator[ast.expr]:
    """Yield the owners in a condition with `not owner.done()`."""
    for node in nodes_in(test):
        match node:
            case ast.UnaryOp(op=ast.Not(), operand=ast.Call(func=ast.Attribute(value=owner, attr="done"))):
                yield owner


def dotted(expression: ast.expr) -> str:
    """Return a name, or an attribute of one, as the code writes it; empty for anything else."""
    return ast.unparse(expression) if isinstance(expression, (ast.Name, ast.Attribute)) else ""


def early_questions(module: ast.AST) -> Iterator[tuple[int, str]]:
    """Find lines that ask whether a future is done right after the call that made it: nothing has spun in between."""
    for node in nodes_in(module):
        body = node.body if isinstance(node, BLOCKS) else []
        for first, second in zip(body, body[1:], strict=False):
            match first, second:
                case (
                    ast.Assign(targets=[target], value=ast.Call(func=ast.Attribute(attr=verb))),
                    ast.If(test=ast.Call(func=ast.Attribute(value=asked, attr="done"))),
                ) if verb in _ASKING and dotted(target) and dotted(target) == dotted(asked):
                    name = dotted(target)
                    text = f"{name} cannot be done yet, since nothing spins between the two lines"
                    yield (
                        second.lineno,
                        f"{text}; write {name}.add_done_callback(...), or await it in an async callback",
                    )


class EarlyReturn(NamedTuple):
    """A line that returns the result of a future which nothing in its function waits for."""

    function: str
    line: int
    text: str


def early_results(module: ast.AST) -> Iterator[tuple[int, str]]:
    """Find lines that return the result of a future which nothing in their function waits for."""
    for found in early_returns(module):
        yield found.line, found.text


def early_returns(module: ast.AST) -> Iterator[EarlyReturn]:
    """Find the same, each with the name of its function."""
    for function in nodes_in(module):
        if not isinstance(function, ast.FunctionDef):
            continue
        names = [last_name(part) for part in nodes_in(function) if isinstance(part, (ast.Attribute, ast.Name))]
        if any(map(_WAITING.search, names)):
            continue
        made: dict[str, int] = {}
        results: dict[str, tuple[str, int]] = {}
        for part in [part for part, _ in walk(function, into_functions=False)]:
            match part:
                case ast.Assign(targets=[target], value=ast.Call(func=ast.Attribute(attr=verb))) if verb in _ASKING:
                    made[dotted(target)] = part.lineno
                case ast.Assign(targets=[target], value=value) if future := _owner(value, made):
                    results[dotted(target)] = future, part.lineno
                case ast.Return(value=value) if value is not None:
                    future, line = results.get(ast.unparse(value), (_owner(value, made), part.lineno))
                    if future:
                        text = f"{future}.result() is None there, since nothing spins after line {made[future]}"
                        node = "self" if [a.arg for a in function.args.args[:1]] == ["self"] else "node"
                        way = f"write before it: rclpy.spin_until_future_complete({node}, {future})"
                        yield EarlyReturn(function.name, line, f"{text}; {way}")


def _owner(value: ast.expr, made: Container[str]) -> str:
    """Return the name of the future whose result an expression is, if it is one of these; else empty."""
    match value:
        case ast.Call(func=ast.Attribute(value=owner, attr="result")) if dotted(owner) in made:
            return dotted(owner)
    return ""
