"""Calls after `rclpy.spin(node)`, which ends only with the program: requests, goals, and nodes created there.

So is a thread that was to spin: `Thread(target=rclpy.spin(node))`.

When a spin has ended, the context is shut down, so calls that need the network would fail as well. What a program
does at its end, such as destroying, logging, saving and plotting, is not reported, and neither is `finally`.
"""

from __future__ import annotations

import ast
import inspect
import logging
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import CodeType, FunctionType, MethodType
from typing import TYPE_CHECKING, NamedTuple

from graphflow.analysis.frames import Frame
from graphflow.analysis.mistakes.calls.called_early import spins_called
from graphflow.analysis.syntax import FunctionNode, first_line, nodes_in, syntax_of
from graphflow.analysis.user_code import is_ours, is_users, short_place
from graphflow.reading import found_text
from rclpy.action.client import ActionClient
from rclpy.client import Client
from rclpy.executors import Executor
from rclpy.impl.deadlock.stacks import stacks

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState

WARN_AFTER = 3.0
"""Seconds that a spin must have lasted."""
LOOK_EVERY = 1.0
"""Seconds between two checks of what threads spin."""
_SENDS = {"call_async", "send_goal_async", "send_goal", "wait_for_service", "wait_for_server"}
_SENDS |= {"spin_until_future_complete"}
"""Methods that need other nodes."""
_DEPTH = 3
"""The number of calls between a line and a method that needs other nodes, at most."""
_SHOWN = 60
"""The length of a call in a message, in characters."""
logger = logging.getLogger("graphflow")


class _Late(NamedTuple):
    """A call after a spin."""

    line: int
    name: str
    is_node: bool
    """Whether it creates a node."""


class Unreached:
    """The spins of one context, each reported once."""

    def __init__(self, life: ContextState) -> None:
        self._life = life
        self._next = 0.0
        self._since: dict[tuple[CodeType, int], float] = {}
        """The monotonic time at which each line was first seen to spin."""
        self._read: set[tuple[CodeType, int]] = set()
        """The lines whose functions have been analysed."""

    def check(self) -> None:
        """Report the calls after spins that have lasted long enough."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + LOOK_EVERY
        frames = {(frame.f_code, frame.f_lineno): frame for frame in _spinning(self._life)}
        self._since = {line: self._since.get(line, now) for line in frames}
        for line, since in self._since.items():
            if now - since >= WARN_AFTER and line not in self._read:
                # The source may be gone or changed, and reading an attribute may run user code that raises.
                with suppress(Exception):
                    _report(frames[line])
                self._read.add(line)


def _spinning(life: ContextState) -> Iterator[Frame]:
    """Yield the user's frames that have called an endless spin of a context."""
    for stack in stacks():
        if not any(executor.context.life is life for executor in stack.spins):
            continue
        frames = stack.levels[0].frames
        at = next((place for place, frame in enumerate(frames) if _is_spin(frame.f_code)), None)
        if stack.is_users and at is not None:
            yield from (frame for frame in frames[:at] if is_users(frame.f_code.co_filename))


def _is_spin(code: CodeType) -> bool:
    """Whether code is `rclpy.spin` or an executor's, which returns when the context is shut down."""
    return code.co_name == "spin" and is_ours(code.co_filename)


def _report(frame: Frame) -> None:
    file = frame.f_code.co_filename
    function = _function_of(frame)
    if function is None:
        return
    for early in spins_called(function):
        if early.line <= frame.f_lineno <= early.end:
            logger.warning("%s: %s", short_place(file, early.line), early.text)
            return
    spin, later = _after(function, frame.f_lineno)
    if spin is None or (not ast.unparse(spin.func).startswith("rclpy.") and _may_be_ended(file, function)):
        return
    found = next((late for statement in later for late in _late_calls(statement, frame)), None)
    if found is not None:
        text = "%s comes after %s, which does not return: %s before that ends; %s"
        done = f"{found.name} is not {'made' if found.is_node else 'called'}"
        way = "make it before, and spin both in one executor" if found.is_node else "call it before, or leave that out"
        shown = ast.unparse(spin)
        shown = shown if len(shown) <= _SHOWN else f"{ast.unparse(spin.func)}(...)"
        logger.warning(text, short_place(file, found.line), shown, done, way)


def _function_of(frame: Frame) -> ast.AST | None:
    """Return the syntax of a frame's function, or of its module."""
    syntax = syntax_of(frame.f_code.co_filename)
    if frame.f_code.co_name == "<module>":
        return syntax.module
    return next((f for f in syntax.functions if first_line(f) == frame.f_code.co_firstlineno), None)


def _after(function: ast.AST, line: int) -> tuple[ast.Call | None, list[ast.stmt]]:
    """Return the call of a line, and the statements that follow it if it returns normally.

    Statements after an enclosing `try` are omitted, as are `except` and `finally`: they are for the end.
    """
    later: list[ast.stmt] = []
    block: list[ast.stmt] = function.body  # type: ignore[attr-defined]
    while True:
        in_line = [i for i, one in enumerate(block) if one.lineno <= line <= (one.end_lineno or 0)]
        if not in_line:
            return None, []
        # Of `rclpy.init(); rclpy.spin(node)` in one line, the second is meant.
        at = next((i for i in in_line if len(in_line) > 1 and "spin" in ast.unparse(block[i])), in_line[0])
        statement = block[at]
        later = [*block[at + 1 :], *later]
        inner = next((b for b in _blocks(statement) if b[0].lineno <= line <= (b[-1].end_lineno or 0)), None)
        if inner is None:
            calls = [
                n for n in nodes_in(statement) if isinstance(n, ast.Call) and n.lineno <= line <= (n.end_lineno or 0)
            ]
            return next(iter(calls), None), list(_until_end(later))
        if isinstance(statement, (ast.Try, ast.TryStar)):
            if inner is not statement.body:
                return None, []
            later = []
        block = inner


def _blocks(statement: ast.stmt) -> Iterator[list[ast.stmt]]:
    for name in ("body", "orelse", "finalbody"):
        if not isinstance(statement, FunctionNode | ast.ClassDef) and (block := getattr(statement, name, None)):
            yield block
    for handler in (*getattr(statement, "handlers", ()), *getattr(statement, "cases", ())):
        yield handler.body


def _until_end(statements: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Return the statements up to one that leaves the function, or that starts over with another context."""
    for statement in statements:
        if isinstance(statement, (ast.Return, ast.Raise)) or "rclpy.init(" in ast.unparse(statement):
            return
        yield statement


def _may_be_ended(file: str, function: ast.AST) -> bool:
    """Whether other code in a file may shut an executor down, whose `spin()` then returns."""
    own = range(getattr(function, "lineno", 0), (getattr(function, "end_lineno", 0) or 0) + 1)
    lines = enumerate(found_text(Path(file), "replace").splitlines(), 1)
    return any(".shutdown(" in line.replace("rclpy.shutdown(", "") for number, line in lines if number not in own)


def _late_calls(statement: ast.stmt, frame: Frame) -> Iterator[_Late]:
    """Yield the calls in a statement that need other nodes, or that create a node."""
    calls = [node for node in nodes_in(statement) if isinstance(node, ast.Call)]
    for call in sorted(calls, key=lambda c: (c.lineno, c.col_offset)):
        name = ast.unparse(call.func).rpartition(".")[2]
        thing = _resolved(call.func, frame)
        if isinstance(thing, type) and any(cls.__module__ == "rclpy.node" for cls in thing.__mro__):
            yield _Late(call.lineno, name, is_node=True)
        elif _needs_others(thing, _DEPTH):
            yield _Late(call.lineno, name, is_node=False)


def _resolved(expression: ast.expr, frame: Frame) -> object:
    """Return the value of an expression, as far as it is known without running code."""
    match expression:
        case ast.Name(id=name):
            return frame.f_locals.get(name, frame.f_globals.get(name))
        case ast.Attribute(value=owner, attr=name):
            thing = _resolved(owner, frame)
            found = inspect.getattr_static(thing, name, None)
            if isinstance(found, FunctionType) and not isinstance(thing, type) and not inspect.ismodule(thing):
                return MethodType(found, thing)
            return found
    return None


def _needs_others(thing: object, depth: int) -> bool:
    """Whether a function needs other nodes, or is a user's function that calls one that does."""
    code = getattr(thing, "__code__", None)
    if not isinstance(code, CodeType) or not depth:
        return False
    if not is_users(code.co_filename):
        owner = getattr(thing, "__self__", None)
        is_call = code.co_name == "call" and isinstance(owner, Client)
        return is_call or (
            code.co_name in _SENDS and (owner is None or isinstance(owner, (Client, ActionClient, Executor)))
        )
    if not _SENDS.isdisjoint(code.co_names):
        return True
    owner = getattr(thing, "__self__", None)
    inner = (inspect.getattr_static(type(owner), name, None) for name in code.co_names) if owner is not None else ()
    return any(
        isinstance(f, FunctionType) and f.__code__ is not code and _needs_others(MethodType(f, owner), depth - 1)
        for f in inner
    )
