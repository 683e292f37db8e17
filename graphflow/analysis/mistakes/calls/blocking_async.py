"""Lines of an `async def` that stop its event loop: `time.sleep`, `input`, and an endless loop without an `await`."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from graphflow.analysis.syntax import last_name, walk

_SHORT = 0.05
"""Seconds that a sleep may take without anybody noticing."""
_PAUSES = (ast.Await, ast.AsyncFor, ast.AsyncWith, ast.Break, ast.Return, ast.Raise, ast.Yield)
"""Syntax that lets others run, or ends a loop."""


def blocking_async(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find such lines; each comes with what to write."""
    for node, parents in walk(code):
        if not _is_async(parents):
            continue
        match node:
            case ast.Call(args=[pause]) if _sleeps(node):
                text = "time.sleep in an async def stops every handler of the process"
                yield node.lineno, f"{text}; write await self.clock.sleep({ast.unparse(pause)})"
            case ast.While(test=ast.Constant(value=True | 1)) if (asking := _input_in(node)) is not None:
                call = ", ".join(["input", *map(ast.unparse, asking.args)])
                text = "input() in an async def stops every handler of the process until a line comes"
                yield asking.lineno, f"{text}; write await self.offload({call})"
            case ast.While(test=ast.Constant(value=True | 1)) if (forgotten := _forgotten_in(node)) is not None:
                text = f"{ast.unparse(forgotten)} without await does not pause, and this loop blocks the process"
                yield forgotten.lineno, f"{text}; write await {ast.unparse(forgotten)}"
            case ast.While(test=ast.Constant(value=True | 1)):
                inside = [part for part, _ in walk(node, into_functions=False)]
                if not any(_pauses(part) or _sleeps(part) for part in inside):  # a sleep is told in its own line
                    text = "this loop never awaits, so no other handler of the process runs"
                    way = "end each turn with await self.clock.sleep(0.1), or write @timer(0.1) in place of the loop"
                    if _is_timer(parents):
                        way = "leave out the loop: the timer repeats what is in it"
                    yield node.lineno, f"{text}; {way}"


def _is_timer(parents: Sequence[ast.AST]) -> bool:
    """Whether the innermost function is a timer's handler."""
    function = next(parent for parent in reversed(parents) if isinstance(parent, ast.AsyncFunctionDef))
    return any(last_name(d.func) == "timer" for d in function.decorator_list if isinstance(d, ast.Call))


def _input_in(loop: ast.While) -> ast.Call | None:
    """Return the call of `input` in a loop; None if there is none."""
    for part, _ in walk(loop, into_functions=False):
        if isinstance(part, ast.Call) and isinstance(part.func, ast.Name) and part.func.id == "input":
            return part
    return None


def _forgotten_in(loop: ast.While) -> ast.Call | None:
    """Return the sleep of a clock, or of asyncio, that a loop without a pause does not await; None if there is none."""
    inside = [part for part, _ in walk(loop, into_functions=False)]
    for part in inside:
        match part:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=owner, attr="sleep")) as call):
                if last_name(owner) in ("clock", "asyncio") and not any(map(_pauses, inside)):
                    return call
    return None


def _sleeps(part: ast.AST) -> bool:
    match part:
        case ast.Call(func=ast.Attribute(value=ast.Name("time"), attr="sleep"), args=[pause]):
            return not _is_short(pause)
    return False


def _pauses(part: ast.AST) -> bool:
    return isinstance(part, _PAUSES) or (isinstance(part, ast.comprehension) and bool(part.is_async))


def _is_async(parents: Sequence[ast.AST]) -> bool:
    """Whether the innermost function around a node is an `async def`."""
    functions = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    inner = next((parent for parent in reversed(parents) if isinstance(parent, functions)), None)
    return isinstance(inner, ast.AsyncFunctionDef)


def _is_short(pause: ast.expr) -> bool:
    return isinstance(pause, ast.Constant) and isinstance(pause.value, int | float) and pause.value < _SHORT
