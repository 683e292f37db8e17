"""Flags: attributes that loops of rclpy nodes poll, and the methods that change them, read from source.

A coarser relative of `deadlock.closed_world`, for source without a running node: it knows no types of attributes.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

Methods = Mapping[str, FunctionNode]
"""The methods of a class, by name."""

_LOOKING = {"is_set", "wait", "get", "keys", "values", "items", "index", "count", "copy", "empty", "qsize", "full"}
"""Methods that do not change their object."""
_TIME = ("time", "monotonic", "perf_counter", "now", "get_clock")
"""Functions that return the time, by which a loop can give up."""
_BEGINNINGS = {"__init__"}
_RCLPYS = ("create_", "add_done_", "Action", "get_logger")
"""Beginnings of the names of rclpy's functions that take a node's methods, and call them back and nothing else."""
_PLAIN = {"str", "len", "print", "float", "int", "abs", "info", "debug", "warn", "warning"}
"""Functions that only read their arguments."""


class Polled(NamedTuple):
    """A polling loop, which only pauses and tests its condition again."""

    text: str
    """The loop as the code writes it: `while not self.there`."""
    flags: frozenset[str]
    """Attributes that decide its condition; empty if something else may end it."""
    gives_up: bool
    """Whether it ends by itself after some time."""


class Changers(NamedTuple):
    """The callbacks that change some attributes."""

    methods: frozenset[str]
    """Callbacks, and methods that a future calls when a response has arrived."""
    is_known: bool
    """Whether no other code changes them."""


def polled(loop: ast.While, methods: Methods) -> Polled | None:
    """Return a loop that pauses in its body, or does nothing there to end it; None for a loop that works."""
    calls = [node for node in _inside(loop.body) if isinstance(node, ast.Call)]
    pauses = not {"sleep", "spin_once"}.isdisjoint(last_name(call.func) for call in calls)
    queries = [node for node in _inside([loop.test]) if isinstance(node, ast.Call)]
    gives_up = any(last_name(call.func) in _TIME for call in queries)
    leaves = any(
        isinstance(node, (ast.Break, ast.Return, ast.Raise))
        for statement in loop.body
        if not (isinstance(statement, ast.If) and "ok()" in ast.unparse(statement.test))
        for node in nodes_in(statement)
    )
    text = f"`while {ast.unparse(loop.test)}`"
    flags = _read(loop.test, methods, set())
    if leaves or flags is None or any(_changes(statement, flag) for statement in loop.body for flag in flags):
        return Polled(text, frozenset(), gives_up) if pauses or _is_empty(loop) else None
    # Without a pause it is a poll only if no call in its body may end it, as a method of the node may, or a function.
    if not pauses and any(_may_end(call.func, methods) for call in calls):
        return None
    return Polled(text, frozenset(flags), gives_up)


def _may_end(function: ast.expr, methods: Methods) -> bool:
    """Whether a call may end the loop around it: of a method of the node, or of a function that may call one."""
    match function:
        case ast.Attribute(value=ast.Name("self"), attr=name):
            return name in methods
        case ast.Name(id=name):
            return name not in _PLAIN and not name[:1].isupper()
    return False


def _is_empty(loop: ast.While) -> bool:
    return all(isinstance(statement, ast.Pass) for statement in loop.body)


def written_from_outside(tree: ast.Module) -> frozenset[str]:
    """Return the attributes that code assigns on something other than `self`."""
    return frozenset(
        node.attr
        for node in nodes_in(tree)
        if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load) and not _root(node)
    )


def changers(flags: frozenset[str], methods: Methods, callbacks: frozenset[str]) -> Changers:
    """Return the callbacks that change some attributes, directly or through methods that they call."""
    changing = {
        name
        for name, function in methods.items()
        if name not in _BEGINNINGS and any(_changes(function, flag) for flag in flags)
    }
    is_known = bool(changing) and not any(_is_given(flag, methods) for flag in flags)
    found, todo, seen = set[str](), list(changing), set(changing)
    while todo:
        name = todo.pop()
        callers = {other for other, function in methods.items() if _calls(function, name)} - _BEGINNINGS
        is_entry = name in callbacks or _follows_an_answer(name, methods)
        if is_entry:
            found.add(name)
        if _is_given(name, methods) or not (is_entry or callers):
            is_known = False  # other code calls it
        todo += callers - seen
        seen |= callers
    return Changers(frozenset(found), is_known)


def _read(test: ast.AST, methods: Methods, seen: set[str]) -> set[str] | None:
    """Return the attributes of the node that decide a condition; None if something else decides it, too."""
    found: set[str] = set()
    for node in _inside([test]):
        match node:
            case ast.Attribute(value=ast.Name("self"), attr=name) if name in methods:
                below = None if name in seen else _read(methods[name], methods, {*seen, name})
                if below is None:
                    return None
                found |= below
            case ast.Attribute(value=ast.Name("self"), attr=name):
                found.add(name)
            case ast.Call(func=ast.Attribute(attr=asked)) if asked in _LOOKING | {"ok", *_TIME}:
                continue
            case ast.Call(func=ast.Attribute(value=ast.Name("self"), attr=name)) if name in methods:
                continue
            case ast.Call(func=ast.Name("len" | "abs" | "all" | "any" | "bool")):
                continue
            case ast.Call():
                return None
    return found - {"get_clock", "context"} or None


def _changes(top: ast.AST, flag: str) -> bool:
    """Whether code assigns an attribute of the node, or a part of it, or calls a method that may change it."""
    for node in nodes_in(top):
        match node:
            case ast.Attribute(ctx=ast.Store() | ast.Del()) | ast.Subscript(ctx=ast.Store() | ast.Del()):
                if _root(node) == flag:
                    return True
            case ast.Call(func=ast.Attribute(value=owner, attr=way)) if way not in _LOOKING and _root(owner) == flag:
                return True
    return False


def _root(expression: ast.expr) -> str:
    """Return `pose` of `self.pose.x`; empty for anything that is not the node's."""
    while isinstance(expression, (ast.Attribute, ast.Subscript)):
        match expression:
            case ast.Attribute(value=ast.Name("self"), attr=name):
                return name
        expression = expression.value
    return ""


def _is_given(name: str, methods: Methods) -> bool:
    """Whether an attribute or method of the node is passed to code that may do more with it than call it back."""
    for node in (node for function in methods.values() for node in nodes_in(function)):
        if not isinstance(node, ast.Call):
            continue
        called = last_name(node.func)
        if called.startswith(_RCLPYS) or called in _PLAIN:
            continue
        arguments = [*node.args, *(keyword.value for keyword in node.keywords)]
        if any(ast.unparse(argument) == f"self.{name}" for argument in arguments):
            return True
    return False


def _calls(function: ast.AST, name: str) -> bool:
    return any(isinstance(n, ast.Call) and ast.unparse(n.func) == f"self.{name}" for n in nodes_in(function))


def _follows_an_answer(name: str, methods: Methods) -> bool:
    return any(
        last_name(n.func) == "add_done_callback" and f"self.{name}" in map(ast.unparse, n.args)
        for function in methods.values()
        for n in nodes_in(function)
        if isinstance(n, ast.Call)
    )


def _inside(tops: Sequence[ast.AST]) -> Iterator[ast.AST]:
    for top in tops:
        yield from nodes_in(top)
