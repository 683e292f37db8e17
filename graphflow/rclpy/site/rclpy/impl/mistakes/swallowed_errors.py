"""Errors of callbacks that a bare `except: pass` around `rclpy.spin` swallows, so that the program ends without a word.

Programs write it for Ctrl-C. Errors that a callback raises by a `raise` of its own are left out, since they may be
meant to end the spin, and so are handlers that do more than clean up.
"""

from __future__ import annotations

import ast
import linecache
import logging
from collections.abc import Iterator
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Self

from graphflow.analysis.syntax import first_line, last_name, syntax_of, walk
from graphflow.analysis.user_code import is_users_frame, parts_of, short_place
from rclpy.impl.callers import caller

if TYPE_CHECKING:
    from rclpy.context import Context

_PYTHONS_OWN = (AttributeError, TypeError, NameError, LookupError, ArithmeticError, ValueError, AssertionError)
_CATCHING_ALL = ("Exception", "BaseException")
_OF_THE_END = ("KeyboardInterrupt", "ExternalShutdownException", "SystemExit")
"""Exceptions that end a spin, and that earlier handlers may catch."""
_CLEANING = ("destroy_node", "shutdown", "try_shutdown")
_reported: set[str] = set()
"""The handlers that have been reported, as `file:line`."""
logger = logging.getLogger("graphflow")


class Spin:
    """A context manager around a spin, which warns of an error that the calling code swallows.

    Args:
        context: The context; after its end, as by Ctrl-C, errors of callbacks are expected.
    """

    def __init__(self, context: Context) -> None:
        self._context = context

    def __enter__(self) -> Self:
        return self

    def __exit__(self, _: object, error: BaseException | None, trace: TracebackType | None) -> None:
        if isinstance(error, _PYTHONS_OWN) and self._context.ok():
            _warn(error, trace, asked.frame if (asked := caller(2)) is not None else None)


def _warn(error: Exception, trace: TracebackType | None, spins: FrameType | None) -> None:
    """Warn, once per handler, if it swallows an error of a callback.

    Args:
        spins: The user's function that spins.
    """
    users = [part for part in parts_of(trace) if is_users_frame(part.tb_frame) and part.tb_frame is not spins]
    line = _handler(spins) if spins is not None and users else 0
    if spins is None or not line or _raises(users[-1]):
        return
    caught = short_place(spins.f_code.co_filename, line)
    if str(caught) in _reported:
        return
    _reported.add(str(caught))
    raised = short_place(users[-1].tb_frame.f_code.co_filename, users[-1].tb_lineno)
    logger.warning(
        "%s ends the spin by %s: %s (%s), which %s swallows: write except (KeyboardInterrupt, "
        "ExternalShutdownException), from rclpy.executors",
        *(users[0].tb_frame.f_code.co_name, type(error).__name__, error, raised, caught),
    )


def _raises(part: TracebackType) -> bool:
    """Whether a line raises an error by a statement of its own."""
    line = linecache.getline(part.tb_frame.f_code.co_filename, part.tb_lineno).lstrip()
    return not line or line.startswith(("raise", "assert"))


def _handler(frame: FrameType) -> int:
    """Return the line of the handler that swallows an error of the line that a function executes; 0 if none does."""
    code, now = frame.f_code, frame.f_lineno
    try:
        syntax = syntax_of(code.co_filename)
    except (OSError, SyntaxError, ValueError):  # no source to be read
        return 0
    named = (f for f in syntax.functions if (f.name, first_line(f)) == (code.co_name, code.co_firstlineno))
    top = syntax.module if code.co_name == "<module>" else next(named, None)
    around = [] if top is None else list(_around(top, now))
    handler = next((item for item in around[-1].handlers if not _is_of_end(item)), None) if around else None
    return handler.lineno if handler is not None and _swallows(handler) else 0


def _around(top: ast.AST, line: int) -> Iterator[ast.Try]:
    """Yield the `try` statements whose bodies contain a line, the innermost last."""
    for node, _ in walk(top, into_functions=False):
        if isinstance(node, ast.Try) and node.body[0].lineno <= line <= (node.body[-1].end_lineno or 0):
            yield from [node] if node.handlers else []


def _is_of_end(handler: ast.ExceptHandler) -> bool:
    """Whether a handler catches only exceptions that end a spin."""
    kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return all(kind is not None and last_name(kind) in _OF_THE_END for kind in kinds)


def _swallows(handler: ast.ExceptHandler) -> bool:
    """Whether a handler catches all errors, and does nothing but clean up."""
    kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    catches = any(kind is None or last_name(kind) in _CATCHING_ALL for kind in kinds)
    return catches and all(map(_is_cleanup, handler.body))


def _is_cleanup(statement: ast.stmt) -> bool:
    match statement:
        case ast.Pass() | ast.Expr(value=ast.Constant()):
            return True
        case ast.Expr(value=ast.Call(func=called)):
            return last_name(called) in _CLEANING
    return False
