"""Locks that code waits for, and their holders, read from frames and from the source of their functions."""

from __future__ import annotations

import ast
import threading
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from graphflow.analysis.class_source import Unknown
from graphflow.analysis.frames import Frame
from graphflow.analysis.syntax import Syntax, first_line, nodes_in, syntax_of, walk
from graphflow.analysis.user_code import is_users

_LOCKS = (type(threading.Lock()), type(threading.RLock()))


class Entering(NamedTuple):
    """A lock that a line waits to acquire."""

    lock: object
    text: str
    """The expression in the source: `self.account.lock`."""


def entered_at(frame: Frame) -> Entering | None:
    """Return the lock that a frame's line enters by `with`, or acquires without a limit; None for none or several."""
    try:
        function = function_of(frame)
    except Unknown:
        return None
    found = []
    for block, expression in _entries(function):
        if expression.lineno <= frame.f_lineno <= block.body[0].lineno and not _is_in_body(frame, block):
            found.append(expression)
    for expression, call in _calls(function, "acquire"):
        if call.lineno <= frame.f_lineno <= (call.end_lineno or 0):
            found.append(expression)
    locks = [Entering(lock, ast.unparse(one)) for one in found if isinstance(lock := _value(one, frame), _LOCKS)]
    return locks[0] if len(locks) == 1 else None


def is_inside(frame: Frame, lock: object) -> bool:
    """Whether the code of a frame holds a lock: within `with`, or between `acquire()` and `release()`."""
    if not is_users(frame.f_code.co_filename):
        return False
    try:
        function = function_of(frame)
    except Unknown:
        return False
    for block, expression in _entries(function):
        if _is_in_body(frame, block) and _value(expression, frame) is lock:
            return True
    taken, given = (
        [call.lineno for expression, call in _calls(function, way) if _value(expression, frame) is lock]
        for way in ("acquire", "release")
    )
    before = [line for line in (*taken, *given) if line < frame.f_lineno]
    return bool(before) and max(before) in taken and any(line >= frame.f_lineno for line in given)


def holds(frames: Iterable[Frame], lock: object) -> bool:
    """Whether any frame of a stack holds a lock."""
    return any(is_inside(frame, lock) for frame in frames)


def only_holder(
    entering: Entering, frames: Iterable[Frame], others: Iterable[tuple[str, Sequence[Frame]]]
) -> str | None:
    """Return the name of the only stack that holds an awaited lock; None for none, several, or unknown.

    Args:
        frames: The frames of the waiting code.
    """
    inside = [(name, stack) for name, stack in others if holds(stack, entering.lock)]
    return inside[0][0] if len(inside) == 1 and is_kept(entering, [*frames, *inside[0][1]]) else None


def is_kept(entering: Entering, frames: Iterable[Frame]) -> bool:
    """Whether each acquirer of a lock also releases it, as far as the files of some frames show.

    A lock that is released elsewhere, or passed to other code such as a `Condition`, may be free all the same.
    """
    name = entering.text.rpartition(".")[2]
    try:
        files = [syntax_of(file) for file in {frame.f_code.co_filename for frame in frames} if is_users(file)]
    except (OSError, SyntaxError, ValueError):
        return False
    return not any(_is_let_go(syntax, name) for syntax in files)


def _is_let_go(syntax: Syntax, name: str) -> bool:
    """Whether a lock of that name is released without having been acquired there, or used in any other way."""
    for function in syntax.functions:
        called = [call.func for call in nodes_in(function) if isinstance(call, ast.Call)]
        ways = [(way.attr, ast.unparse(way.value)) for way in called if isinstance(way, ast.Attribute)]
        entered = {ast.unparse(expression) for _, expression in _entries(function)}
        released = {text for attr, text in ways if attr == "release" and text.rpartition(".")[2] == name}
        if released & entered or released - {text for attr, text in ways if attr == "acquire"}:
            return True
    for node, parents in walk(syntax.module):
        is_read = isinstance(node, (ast.Name, ast.Attribute)) and isinstance(node.ctx, ast.Load) and _last(node) == name
        if is_read and not isinstance(parents[-1], (ast.withitem, ast.Attribute)):
            return True
    return False


def _is_in_body(frame: Frame, block: ast.With) -> bool:
    """Whether a frame is in the body of a `with`, which may stand on its line."""
    first = block.body[0]
    if frame.f_lineno == first.lineno and frame.column is not None:
        return frame.column >= first.col_offset
    return first.lineno <= frame.f_lineno <= (block.end_lineno or 0)


def _entries(function: ast.AST) -> Iterator[tuple[ast.With, ast.expr]]:
    """Yield what is entered with `with`."""
    for block in nodes_in(function):
        if isinstance(block, ast.With):
            yield from ((block, item.context_expr) for item in block.items)


def _calls(function: ast.AST, way: str) -> Iterator[tuple[ast.expr, ast.Call]]:
    """Yield the objects whose `acquire()` or `release()` is called, as a statement and without arguments."""
    for statement in nodes_in(function):
        match statement:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=owner, attr=attr), args=[], keywords=[]) as call):
                if attr == way:
                    yield owner, call


def _last(expression: ast.expr) -> str:
    """`lock` of `self.account.lock`."""
    return ast.unparse(expression).rpartition(".")[2] if isinstance(expression, (ast.Name, ast.Attribute)) else ""


def _value(expression: ast.expr, frame: Frame) -> object:
    """Return the value of an expression in a frame: a name, or a stored attribute; None for anything else."""
    match expression:
        case ast.Name(id=name):
            return frame.f_locals.get(name, frame.f_globals.get(name))
        case ast.Attribute(value=owner, attr=name):
            found = _value(owner, frame)
            spaces = [getattr(found, "__dict__", {}), *(vars(cls) for cls in type(found).__mro__)]
            return next((space[name] for space in spaces if name in space), None)
    return None


def function_of(frame: Frame) -> ast.AST:
    """Return the syntax of a frame's function or module. Raises Unknown if there is none."""
    try:
        syntax = syntax_of(frame.f_code.co_filename)
    except (OSError, SyntaxError, ValueError):
        raise Unknown from None
    if frame.f_code.co_name == "<module>":
        return syntax.module
    for function in syntax.functions:
        if first_line(function) == frame.f_code.co_firstlineno and function.name == frame.f_code.co_name:
            return function
    raise Unknown
