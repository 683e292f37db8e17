"""Exceptions that handlers must not catch: CancelledError without raising it again, and KeyboardInterrupt."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from types import CodeType

from graphflow.analysis.syntax import FunctionNode, first_line, last_name, nodes_in, syntax_of
from graphflow.analysis.user_code import short_place
from graphflow.errors import Place

_INTERRUPT = "KeyboardInterrupt"
_INSTEAD = "write finally: in place of except, or do this in async def on_shutdown(self)"
_ENDLESS = (
    "this also catches CancelledError, so that nothing can end the loop: write except Exception, or raise it again"
)
_CAUGHT = {"CancelledError", "BaseException"}


def where_caught(handler: Callable[..., object]) -> str:
    """Return the end of a message, with the lines at which a handler swallows its cancellation; empty for none."""
    lines = " and ".join(map(str, _swallowing(getattr(handler, "__code__", None))))
    return f"; CancelledError is caught in {lines}" if lines else ""


def _swallowing(code: CodeType | None) -> list[Place]:
    try:
        functions = syntax_of(code.co_filename).functions if code is not None else []
    except (OSError, SyntaxError, ValueError):  # no source to be read
        return []
    return [
        short_place(code.co_filename, line)
        for function in functions
        if code is not None and (function.name, first_line(function)) == (code.co_name, code.co_firstlineno)
        for line in sorted(_lines(function))
    ]


def _lines(function: ast.AST) -> Iterator[int]:
    for node in nodes_in(function):
        if isinstance(node, ast.ExceptHandler):
            if catching(node) and not any(isinstance(inner, ast.Raise) for inner in nodes_in(node)):
                yield node.lineno
        elif isinstance(node, ast.Call) and last_name(node.func) == "suppress" and any(map(_catches, node.args)):
            yield node.lineno


def catching(handler: ast.ExceptHandler) -> bool:
    """Whether an `except` catches CancelledError."""
    return _catches(handler.type)


def caught_in_vain(definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Yield the lines of a node's handlers and coroutines that catch KeyboardInterrupt, each with the remedy.

    Programs do so to stop a robot; but graphflow handles Ctrl-C itself, and cancels the handlers.
    """
    for method in definition.body:
        if not isinstance(method, FunctionNode):
            continue
        decorators = {last_name(d.func if isinstance(d, ast.Call) else d) for d in method.decorator_list}
        if decorators & {"staticmethod", "classmethod"} or not (decorators or isinstance(method, ast.AsyncFunctionDef)):
            continue  # it may be called before the event loop runs, where Ctrl-C does raise
        for node in nodes_in(method):
            if isinstance(node, ast.ExceptHandler) and node.type is not None and last_name(node.type) == _INTERRUPT:
                works = [s for s in node.body if not isinstance(s, (ast.Raise, ast.Pass))]
                text = f"{_INTERRUPT} does not come to a node, which Ctrl-C cancels: {_INSTEAD}"
                yield from [(node.lineno, text)] if works else []


def endless_loops(definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Yield the lines that catch CancelledError at an await in a loop, which then goes on for ever."""
    for method in definition.body:
        if not isinstance(method, ast.AsyncFunctionDef):
            continue
        found: set[int] = set()
        for loop in nodes_in(method):
            if isinstance(loop, ast.While):
                tries = (node for node in nodes_in(loop) if isinstance(node, ast.Try) and _awaits(node))
                found |= {handler.lineno for node in tries for handler in node.handlers if _goes_on(handler, loop)}
        yield from ((line, _ENDLESS) for line in sorted(found))


def _awaits(node: ast.Try) -> bool:
    return any(isinstance(part, ast.Await) for statement in node.body for part in nodes_in(statement))


def _goes_on(handler: ast.ExceptHandler, loop: ast.While) -> bool:
    """Whether a loop goes on after a cancellation; a condition may depend on what the handler sets."""
    ends: tuple[type[ast.AST], ...] = (ast.Raise, ast.Return, ast.Break)
    ends += () if isinstance(loop.test, ast.Constant) else (ast.Assign,)
    return catching(handler) and not any(isinstance(node, ends) for node in nodes_in(handler))


def _catches(caught: ast.expr | None) -> bool:
    """Whether an `except` catches CancelledError; without a class it catches everything."""
    if isinstance(caught, ast.Tuple):
        return any(map(_catches, caught.elts))
    return caught is None or last_name(caught) in _CAUGHT
