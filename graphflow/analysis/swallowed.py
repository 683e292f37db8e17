"""Lines of a source that catch CancelledError and do not let it pass, or KeyboardInterrupt, which does not come."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from types import CodeType
from typing import Any

from graphflow.analysis.syntax import FunctionNode, first_line, syntax_of
from graphflow.analysis.user_code import short_place
from graphflow.errors import Place

_INTERRUPT = "KeyboardInterrupt"
_INSTEAD = "write finally: in place of except, or do this in async def on_shutdown(self)"
_CAUGHT = {"CancelledError", "BaseException"}


def where_caught(handler: Callable[..., Any]) -> str:
    """The lines by which a handler may have outlived its cancellation, for the end of a sentence; empty without any."""
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
    for node in ast.walk(function):
        if isinstance(node, ast.ExceptHandler):
            if _catches(node.type) and not any(isinstance(inner, ast.Raise) for inner in ast.walk(node)):
                yield node.lineno
        elif isinstance(node, ast.Call) and _word(node.func) == "suppress" and any(map(_catches, node.args)):
            yield node.lineno


def caught_in_vain(definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Lines of a node's handlers and coroutines that catch KeyboardInterrupt, as to stop a robot, and what to write.

    Ctrl-C is a signal that graphflow takes: it cancels what runs.
    """
    for method in definition.body:
        if not isinstance(method, FunctionNode):
            continue
        marks = {_word(d.func if isinstance(d, ast.Call) else d) for d in method.decorator_list}
        if marks & {"staticmethod", "classmethod"} or not (marks or isinstance(method, ast.AsyncFunctionDef)):
            continue  # it may be called where nothing runs yet
        for node in ast.walk(method):
            if isinstance(node, ast.ExceptHandler) and node.type is not None and _word(node.type) == _INTERRUPT:
                does = [s for s in node.body if not isinstance(s, (ast.Raise, ast.Pass))]
                told = f"{_INTERRUPT} does not come to a node, which Ctrl-C cancels: {_INSTEAD}"
                yield from [(node.lineno, told)] if does else []


def _catches(caught: ast.expr | None) -> bool:
    """Whether CancelledError is among the classes of an `except`; all are where it names none."""
    if isinstance(caught, ast.Tuple):
        return any(map(_catches, caught.elts))
    return caught is None or _word(caught) in _CAUGHT


def _word(node: ast.expr) -> str:
    """The last part of a name with dots."""
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
