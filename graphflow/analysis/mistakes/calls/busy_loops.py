"""Loops that turn without a pause, and loops around `spin_once` that pause for too long."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk

_LONGEST_PAUSE = 0.2
"""Seconds that a loop around `spin_once` may sleep: beside it, most sensors publish more often."""


def busy_loops(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines of such loops; each comes with a sentence."""
    for loop, parents in walk(code):
        if isinstance(loop, ast.While):
            around = next((one for one in reversed(parents) if isinstance(one, FunctionNode)), None)
            yield from _without_pause(loop, around)
            yield from _between_spins(loop)


def _without_pause(loop: ast.While, around: FunctionNode | None) -> Iterator[tuple[int, str]]:
    match loop.body:
        case [ast.Expr(value=ast.Await(value=ast.Call(func=ast.Attribute(attr="sleep") as sleep, args=[time])))]:
            if _number(time) == 0:
                text = "this loop never pauses, and takes a whole core"
                way = f"write await {ast.unparse(sleep)}(0.05), or await an asyncio.Event that the handler sets"
                yield loop.lineno, f"{text}; {way}"
        case [ast.Expr(value=ast.Call(func=function) as call)] if last_name(function) == "spin_once":
            given = [*call.args[1:], *(k.value for k in call.keywords if k.arg == "timeout_sec")]
            if any(_number(time) == 0 for time in given):
                text = "this loop never pauses, and takes a whole core"
                yield loop.lineno, f"{text}; leave out timeout_sec, so that spin_once waits for a callback"
        case [ast.Pass()] if _only_reads(loop.test):
            text = "this loop never pauses, and nothing else runs in its thread"
            yield loop.lineno, f"{text}; {_way_to_wait(around)}"


def _way_to_wait(function: FunctionNode | None) -> str:
    """Return the advice for a loop that waits for an attribute or a name, by the function that it is in."""
    if isinstance(function, ast.AsyncFunctionDef):
        return "return from it, and go on in the handler that it waits for"
    if function is not None and function.args.args and function.args.args[0].arg == "self":
        return "if a callback ends it, go on there, or in a timer"
    return "if a callback of a node ends it, call rclpy.spin_once(node) in it"


def _between_spins(loop: ast.While) -> Iterator[tuple[int, str]]:
    calls = [node.value for node in loop.body if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)]
    if not any(last_name(call.func) == "spin_once" for call in calls):
        return
    for call in calls:
        if last_name(call.func) == "sleep" and call.args:
            pause = _number(call.args[0])
            if pause is not None and pause >= _LONGEST_PAUSE:
                text = f"spin_once runs one callback, and this sleep keeps the next one waiting {pause:g} s"
                way = f"write rclpy.spin(node), and a timer for the work of each {pause:g} s"
                yield call.lineno, f"{text}: messages grow old and are lost; {way}"


def _only_reads(test: ast.expr) -> bool:
    """Whether a condition has no effect and can change."""
    return not isinstance(test, ast.Constant) and not any(isinstance(part, ast.Call) for part in nodes_in(test))


def _number(value: ast.expr) -> float | None:
    match value:
        case ast.Constant(value=int(number) | float(number)):
            return number
    return None
