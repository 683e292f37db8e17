"""Lines of a handler that catch CancelledError and do not let it pass, read from its source."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from types import CodeType
from typing import Any

from graphflow.deadlock.syntax import first_line, syntax_of
from graphflow.deadlock.user_code import short_place
from graphflow.errors import Place

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


def _catches(caught: ast.expr | None) -> bool:
    """Whether CancelledError is among the classes of an `except`; all are where it names none."""
    if isinstance(caught, ast.Tuple):
        return any(map(_catches, caught.elts))
    return caught is None or _word(caught) in _CAUGHT


def _word(node: ast.expr) -> str:
    """The last part of a name with dots."""
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
