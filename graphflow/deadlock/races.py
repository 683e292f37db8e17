"""Detection of lost updates in the attributes of nodes, an option (`up --races`, GRAPHFLOW_RACES=1).

A handler reads `self.x` and suspends; another writes it meanwhile; the first then writes a value derived from the old
one. The other's write is lost in silence, since no line is wrong by itself. In the terms of transactions, the schedule
is not serializable: read(A), write(B), write(A).

A write is reported only if all of this holds: the same run has read the attribute before; another one has written it
since; the new value differs from the one it overwrites; and by the source of the method the write derives from the
read: its right side uses the attribute or a variable derived from it, or it is in an `if` or `while` that tests it.

Not detected are changes inside objects (`self.points.append`), handlers in threads, attributes set by `setattr` or
through another name, and values that reach the write through another method.
"""

from __future__ import annotations

import ast
import asyncio
import logging
import os
import sys
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from functools import cache
from pathlib import Path, PurePath
from types import FrameType
from typing import NamedTuple
from weakref import WeakKeyDictionary

from graphflow.analysis.syntax import children_of, nodes_in
from graphflow.deadlock.asyncio_frames import TaskLike
from graphflow.errors import Place
from graphflow.executor.runner import Run
from graphflow.reading import found_text, parsed

VARIABLE = "GRAPHFLOW_RACES"


def is_wanted() -> bool:
    """Whether the environment switches the detection on."""
    return os.environ.get(VARIABLE, "") not in ("", "0")


class _Access(NamedTuple):
    """One read or write of an attribute."""

    version: int
    """Number of writes of the attribute so far, this one included."""
    who: str
    """Name of the run or task for reports."""
    method: str
    """Name of the handler or of the task's function."""
    place: Place
    by: TaskLike | None
    """Run or task; None outside of any."""


def watch(node: object, full_name: str, logger: logging.Logger, ignored: AbstractSet[str]) -> None:
    """Record every access to a node's own attributes.

    The node gets a subclass of its class with the two attribute hooks, so that other instances are not slowed down.

    Args:
        node: The user's object.
        ignored: Attributes that every node has.
    """
    cls, log = type(node), _Log(node, full_name, logger)
    mine = {name for name in dir(cls) if _is_method(cls, name)} | ignored

    def read(self: object, name: str) -> object:
        value: object = object.__getattribute__(self, name)
        if name not in mine and not name.startswith("__"):
            log.read(name, sys._getframe(1))
        return value

    def write(self: object, name: str, value: object) -> None:
        if name not in mine:
            log.write(name, value, sys._getframe(1))
        object.__setattr__(self, name, value)

    copied = {"__module__": cls.__module__, "__qualname__": cls.__qualname__, "__doc__": cls.__doc__}
    body = {
        **copied,
        # By this, `inspect` finds the source of a class since 3.13.
        "__firstlineno__": getattr(cls, "__firstlineno__", 0),
        "__getattribute__": read,
        "__setattr__": write,
    }
    node.__class__ = type(cls.__name__, (cls,), body)


def _is_method(cls: type, name: str) -> bool:
    """Whether a class attribute is a method or descriptor rather than the default of plain data."""
    value = next((vars(c)[name] for c in cls.__mro__ if name in vars(c)), None)
    return callable(value) or hasattr(value, "__get__")


class _Log:
    """The reads and writes of one node's attributes."""

    def __init__(self, node: object, full_name: str, logger: logging.Logger) -> None:
        self._node, self._full_name, self._logger = node, full_name, logger
        self._written: dict[str, _Access] = {}
        self._read: WeakKeyDictionary[TaskLike, dict[str, _Access]] = WeakKeyDictionary()
        self._reported: set[tuple[str, Place, Place]] = set()

    def read(self, name: str, frame: FrameType) -> None:
        actor = _actor()
        if actor is not None:
            last = self._written.get(name)
            self._read.setdefault(actor, {})[name] = self._access(0 if last is None else last.version, actor, frame)

    def write(self, name: str, value: object, frame: FrameType) -> None:
        actor, last = _actor(), self._written.get(name)
        access = self._access(1 if last is None else last.version + 1, actor, frame)
        if actor is not None:
            seen = self._read.get(actor, {}).get(name)
            if seen is not None and last is not None and last.version != seen.version and last.by is not actor:
                self._compare(name, value, seen, last, access, frame)
            self._read.setdefault(actor, {})[name] = access
        self._written[name] = access

    def _compare(
        self, name: str, value: object, seen: _Access, other: _Access, access: _Access, frame: FrameType
    ) -> None:
        """Report a write over another one, if the value derives from a read before that."""
        now = vars(self._node).get(name, value)
        spot = (name, access.place, other.place)
        if spot in self._reported or now is value or _is_equal(now, value) or not _comes_of_read(name, frame):
            return
        self._reported.add(spot)
        # Logged as if by the line that writes, which users open from /rosout: it is above `write` here and in `watch`.
        self._logger.warning("%s", _text(self._full_name, name, seen, other, access), stacklevel=4)

    def _access(self, version: int, actor: TaskLike | None, frame: FrameType) -> _Access:
        place = Place(frame.f_code.co_filename, frame.f_lineno)
        if isinstance(actor, Run):
            return _Access(version, actor.runner.title, actor.runner.spec.handler, place, actor)
        method = frame.f_code.co_name if actor is None else str(getattr(actor.get_coro(), "__name__", ""))
        return _Access(version, f"task {method}" if actor is not None else method, method, place, actor)


def _actor() -> TaskLike | None:
    """Return the current run or task; None in a `def` handler on the loop, which nothing interrupts, and in threads."""
    try:
        return asyncio.current_task()
    except RuntimeError:
        return None


def _is_equal(a: object, b: object) -> bool:
    try:
        return bool(a == b)
    except Exception:  # comparison of users' objects or numpy arrays may raise anything
        return False


def _text(node: str, name: str, seen: _Access, other: _Access, access: _Access) -> str:
    def at(place: Place) -> str:
        return f"{PurePath(place.file).name}:{place.line}"

    handlers = list(dict.fromkeys([access.method, other.method]))
    together = f"{node}: {{concurrency: {{state: [{', '.join(handlers)}]}}}}"
    return (
        f"RACE: an update of self.{name} is lost\n"
        f"  {access.who} of {node} read it in {at(seen.place)} and waited,\n"
        f"  {other.who} wrote it meanwhile in {at(other.place)},\n"
        f"  and {access.who} has overwritten that in {at(access.place)}.\n"
        f"Write it before the `await`, or let the two exclude each other, in the graph file\n"
        f"      {together}"
    )


def _comes_of_read(name: str, frame: FrameType) -> bool:
    """Whether, by the source, the value that a line writes to an attribute derives from a read of the same one."""
    function = _function(frame.f_code.co_filename, frame.f_code.co_firstlineno)
    if function is None:
        return False
    derived = _derived(function, name)
    for statement, guards in _statements(function):
        first, last = getattr(statement, "lineno", 0), getattr(statement, "end_lineno", 0) or 0
        if not first <= frame.f_lineno <= last or not isinstance(statement, (ast.Assign, ast.AugAssign, ast.AnnAssign)):
            continue
        targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
        if not any(_uses(target, name, set()) for target in targets):
            continue
        if isinstance(statement, ast.AugAssign):
            return True
        value = statement.value
        return (value is not None and _uses(value, name, derived)) or any(_uses(g, name, derived) for g in guards)
    return False


def _uses(expression: ast.AST, name: str, derived: set[str]) -> bool:
    """Whether `self.name`, or a variable derived from it, occurs in an expression."""
    return any(
        (isinstance(n, ast.Attribute) and n.attr == name and isinstance(n.value, ast.Name) and n.value.id == "self")
        or (isinstance(n, ast.Name) and n.id in derived)
        for n in nodes_in(expression)
    )


def _derived(function: ast.AST, name: str) -> set[str]:
    """Return the local variables that derive from `self.name`, directly or through each other."""
    found: set[str] = set()
    while True:
        more = {
            target.id
            for node in nodes_in(function)
            if isinstance(node, ast.Assign) and _uses(node.value, name, found)
            for whole in node.targets
            for target in nodes_in(whole)
            if isinstance(target, ast.Name)
        } - {"self"}
        if more <= found:
            return found
        found |= more


def _statements(function: ast.AST) -> Iterator[tuple[ast.AST, tuple[ast.expr, ...]]]:
    """Yield the nodes of a function, each with the tests of the branches that it is in."""
    todo: list[tuple[ast.AST, tuple[ast.expr, ...]]] = [(function, ())]
    while todo:
        node, guards = todo.pop()
        yield node, guards
        inner = (*guards, node.test) if isinstance(node, (ast.If, ast.While)) else guards
        todo += [(child, inner) for child in children_of(node)]


@cache
def _function(file: str, line: int) -> ast.AST | None:
    try:
        module = parsed(found_text(Path(file)))
    except (OSError, SyntaxError, ValueError):
        return None
    for node in nodes_in(module):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            first = node.decorator_list[0].lineno if node.decorator_list else node.lineno
            if first == line:
                return node
    return None
