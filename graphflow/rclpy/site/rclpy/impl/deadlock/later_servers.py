"""Servers that a program creates only later: the code that would create an awaited one, according to the source."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple

from graphflow.analysis.class_source import Unknown, source_of
from graphflow.analysis.frames import Frame
from graphflow.analysis.syntax import FunctionNode, first_line, loops_at, nodes_in, syntax_of
from graphflow.analysis.user_code import is_users, short_place
from graphflow.deadlock.closed_world.wakers import handlers_above
from graphflow.deadlock.protocols import Subject

_MAKERS = {"create_service": 1, "ActionServer": 2}
"""Calls that create servers, with the position of the name among their arguments."""
_NAMES = {"srv_name", "action_name"}
_ACTION = "/_action/"
_ASKS = re.compile(r"\.(wait_for_s|service_is_ready|server_is_ready)")
"""Methods that check, or wait for, a client's server."""


class Opening(NamedTuple):
    """The code that creates an awaited server."""

    handlers: frozenset[str]
    """Methods that run as callbacks."""
    is_own: bool
    """Whether the waiting code creates the server itself, further on."""


class _Offer(NamedTuple):
    """A place in the source that creates a server."""

    file: str
    call: ast.Call
    parents: Sequence[ast.AST]
    name: str | None
    """The server's name; None if it is not a literal."""

    @property
    def function(self) -> FunctionNode | None:
        """The function that creates it; None outside functions, and in lambdas."""
        inner = next((p for p in reversed(self.parents) if isinstance(p, (FunctionNode, ast.Lambda))), None)
        return inner if isinstance(inner, FunctionNode) else None

    @property
    def cls(self) -> str:
        """The class that creates it; empty for none."""
        return next((parent.name for parent in self.parents if isinstance(parent, ast.ClassDef)), "")

    @property
    def owner(self) -> ast.expr | None:
        """The expression of the node that owns the server."""
        if isinstance(self.call.func, ast.Attribute) and self.call.func.attr == "create_service":
            return self.call.func.value
        given = [k.value for k in self.call.keywords if k.arg == "node"]
        return next(iter([*given, *self.call.args[:1]]), None)


def opening_of(
    service: str, frames: list[Frame], node: Subject, others: Iterable[Any], files: Iterable[str]
) -> Opening | None:
    """Return the code that creates the server for which other code waits; None if unknown.

    Args:
        frames: The frames of the waiting code, outermost first.
        node: The waiting node.
        others: The other nodes of the process.
        files: The program's files.
    """
    name, _, part = service.partition(_ACTION)
    maker = "ActionServer" if part else "create_service"
    methods, is_own = set[str](), False
    classes = {cls.__name__ for other in (node.instance, *others) for cls in type(other).__mro__}
    for offer in (offer for file in files for offer in _offers(file) if _last(offer.call.func) == maker):
        if offer.name is None:
            return None
        if offer.name.rpartition("/")[2] != name.rpartition("/")[2]:
            continue
        frame = next((frame for frame in frames if _is_of(frame, offer)), None)
        if frame is not None and _follows(offer, frame.f_lineno) and _resolved(offer, frame) == name:
            is_own = True
        elif (method := _method_of(offer, node)) and node.instance.resolve_service_name(offer.name) == name:  # type: ignore[attr-defined]
            methods.add(method)
        elif offer.cls in classes or not offer.cls:
            return None
    try:
        found = handlers_above(name, methods, node) if methods else None
    except Unknown:
        return None
    handlers = frozenset[str]() if found is None or found.parts else found.handlers
    return Opening(handlers, is_own) if handlers or is_own else None


def comes_after(frames: Iterable[Frame]) -> str:
    """Note that a waiting `__init__` creates servers only after the wait; the end of a sentence, or empty."""
    for frame in frames:
        is_init = frame.f_code.co_name == "__init__" and is_users(frame.f_code.co_filename)
        offers = _offers(frame.f_code.co_filename) if is_init else []
        later = [one for one in offers if _is_of(frame, one) and _follows(one, frame.f_lineno)]
        first = min(later, key=lambda offer: offer.call.lineno, default=None)
        if first is not None:
            place = short_place(first.file, first.call.lineno)
            what = "another server" if first.name is None else first.name
            is_ = "are" if later[1:] else "is"
            others = f" and {len(later) - 1} more" if later[1:] else ""
            way = "offer first, or wait outside of __init__"
            return f"; {what} ({place}){others} {is_} offered only after this wait: {way}"
    return ""


def tries_forever(frame: Frame) -> bool:
    """Whether a frame's line is in a loop that ends only when something is available, or with the program."""
    code = frame.f_code
    loops = [
        loop
        for syntax in _syntaxes(code.co_filename)
        for loop in loops_at(syntax, code.co_firstlineno, frame.f_lineno)
        if isinstance(loop, ast.While)
    ]
    return bool(loops) and _is_endless(loops[-1])


def _is_endless(loop: ast.While) -> bool:
    parts = loop.test.values if isinstance(loop.test, ast.BoolOp) and isinstance(loop.test.op, ast.And) else [loop.test]
    waits = [part for part in parts if isinstance(part, ast.UnaryOp) and _ASKS.search(ast.unparse(part))]
    others = [part for part in parts if part not in waits and not ast.unparse(part).endswith("ok()")]
    leaving = [
        node
        for statement in loop.body
        if not (isinstance(statement, ast.If) and "ok()" in ast.unparse(statement.test))
        for node in nodes_in(statement)
        if isinstance(node, (ast.Break, ast.Return, ast.Raise))
    ]
    return len(waits) == 1 and not others and not leaving


@cache
def _offers(file: str) -> list[_Offer]:
    found = []
    for syntax in _syntaxes(file):
        for node, parents in syntax.parts:
            if isinstance(node, ast.Call) and _last(node.func) in _MAKERS:
                at = _MAKERS[_last(node.func)]
                given = next((k.value for k in node.keywords if k.arg in _NAMES), None) or [*node.args, *[None] * 3][at]
                text = given.value if isinstance(given, ast.Constant) and isinstance(given.value, str) else None
                found.append(_Offer(file, node, parents, text))
    return found


def _syntaxes(file: str) -> Iterator[Any]:
    """Yield the syntax tree of a file; nothing if it cannot be read."""
    try:
        yield syntax_of(file)
    except (OSError, SyntaxError, ValueError):
        return


def _is_of(frame: Frame, offer: _Offer) -> bool:
    """Whether a frame runs the function, or module, that creates a server."""
    return frame.f_code.co_filename == offer.file and frame.f_code.co_firstlineno == _code_line(offer.function)


def _code_line(function: ast.AST | None) -> int:
    return first_line(function) if isinstance(function, FunctionNode) else 1


def _follows(offer: _Offer, line: int) -> bool:
    """Whether the creation of a server follows a line on the same path through the code."""
    for parent, child in zip(offer.parents, [*offer.parents[1:], offer.call], strict=True):
        for block in (getattr(parent, field, None) for field in ("body", "orelse", "finalbody")):
            statements = block if isinstance(block, list) else []
            if child in statements and any(
                statement.lineno <= line <= (statement.end_lineno or 0)
                for statement in statements[: statements.index(child)]
            ):
                return True
    return False


def _resolved(offer: _Offer, frame: Frame) -> str:
    """Return the full name of the service or action that a function will offer; empty if its node is unknown."""
    match offer.owner:
        case ast.Name(id=name):
            resolve = getattr(frame.f_locals.get(name), "resolve_service_name", None)
            return str(resolve(offer.name)) if resolve is not None else ""
    return ""


def _method_of(offer: _Offer, node: Subject) -> str:
    """Return the node's own method that creates one of its servers; empty for anything else."""
    match offer.owner, offer.function:
        case ast.Name(id="self"), (ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name)) as function:
            return name if function in source_of(node.instance).methods.get(name, []) else ""
    return ""


def _last(expression: ast.expr) -> str:
    return ast.unparse(expression).rpartition(".")[2]
