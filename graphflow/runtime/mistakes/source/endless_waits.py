"""Waits for what nothing ends: an Event that is never set, a Queue that nothing fills, a flag that stays as it is.

Also loops over a subscription in a handler, which keep it from running again, and workers that take one item only.

At run time they look like waits for an event from outside. Where other code may reach the attribute, nothing is said.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.class_source import ClassSource, Unknown
from graphflow.analysis.syntax import LOOPS, FunctionNode, last_name, nodes_in, walk
from graphflow.runtime.declarations.declare import Subscription


class _Kind(NamedTuple):
    """A kind of object to wait for."""

    waits: str
    """The method that waits."""
    ends: str
    """The method that ends the wait."""
    does: str
    """The verb for that."""
    harmless: frozenset[str]
    """Methods that do not end the wait."""


_KINDS = {
    "Event": _Kind("wait", "set()", "sets", frozenset({"wait", "is_set", "clear"})),
    "Queue": _Kind("get", "put(...)", "puts anything into", frozenset({"get", "empty", "qsize", "full", "task_done"})),
    "Lock": _Kind("acquire", "release()", "releases", frozenset({"acquire", "locked"})),
    "create_future": _Kind("", "set_result(...)", "ends", frozenset({"done", "result", "exception", "cancelled"})),
}
_REPEATED = {"timer", "subscription", "service"}
"""Decorators of methods that run again and again."""
_ANSWERED = {"subscription", "service"}
"""Decorators of methods that are called with a message or a request."""
_MISSING = object()


def endless_waits(cls: type, definition: ast.ClassDef, module: ast.Module) -> Iterator[tuple[int, str, str]]:
    """Find the lines of such waits in a class; each comes with the attribute, if there is one, and a sentence.

    Args:
        cls: The class that the definition makes, or one that derives from it.
        module: The file with the definition.
    """
    for line, name, text in _waits(cls, definition):
        if not has_attribute(module, name, outside=definition):
            yield line, name, text


def has_attribute(module: ast.Module, name: str, outside: ast.ClassDef | None = None) -> bool:
    """Whether a file mentions an attribute of a name, perhaps only outside of a class."""
    lines = range(outside.lineno, (outside.end_lineno or 0) + 1) if outside is not None else ()
    return any(
        isinstance(node, ast.Attribute) and node.attr == name and node.lineno not in lines for node in nodes_in(module)
    )


def _waits(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str, str]]:
    with suppress(Unknown):
        source = ClassSource.of(cls)
        for node, parents in walk(definition):
            yield from _in_handlers(cls, definition, source, node, parents)
            match node:
                case ast.Await(value=ast.Attribute() as thing) if is_own(thing) and not _is_limited(parents):
                    if text := _of_object(source, thing.attr, ""):
                        yield node.lineno, thing.attr, f"{cls.__name__} waits for self.{thing.attr}, and {text}"
                case ast.Call(func=ast.Attribute(value=ast.Attribute() as thing, attr=method), args=[], keywords=[]):
                    if is_own(thing) and _is_unbounded(parents) and (text := _of_object(source, thing.attr, method)):
                        yield node.lineno, thing.attr, f"{cls.__name__} waits for self.{thing.attr}, and {text}"
                case ast.While(test=test) if not _may_leave(node):
                    flag, staying = _polled(test)
                    if flag and _stays(cls, source, flag, staying):
                        text = f"nothing in {cls.__name__} sets it to anything but {staying[0]}"
                        yield node.lineno, flag, f"this loop waits for self.{flag}, and {text}"


def _in_handlers(
    cls: type, definition: ast.ClassDef, source: ClassSource, node: ast.AST, parents: Sequence[ast.AST]
) -> Iterator[tuple[int, str, str]]:
    """Find loops that keep a handler from running again, and workers that take one item."""
    handler = _decorators(next((p for p in parents if isinstance(p, FunctionNode)), None))
    match node:
        case ast.AsyncFor(iter=ast.Attribute() as thing) if is_own(thing) and handler & _REPEATED:
            if isinstance(inspect.getattr_static(cls, thing.attr, None), Subscription) and not _may_leave(node):
                text = f"this loop never ends, so that the {' '.join(handler & _REPEATED)} runs once"
                yield node.lineno, thing.attr, f"{text}: read self.{thing.attr} in a method with @task"
        case ast.While(test=ast.Constant(value=True)) if handler & _ANSWERED and not _may_leave(node):
            what = "message" if "subscription" in handler else "request"
            text = f"this loop never ends, so that only one {what} is handled"
            yield node.lineno, "", f"{text}: let the handler return, and loop in a method with @task"
        case ast.Await(value=ast.Call(func=ast.Attribute(value=ast.Attribute() as thing, attr="get"), args=[])):
            is_once = "task" in handler and not any(isinstance(parent, LOOPS) for parent in parents)
            if is_own(thing) and is_once and _is_filled_again(definition, source, thing.attr):
                text = f"this task takes one item of self.{thing.attr} and ends"
                yield node.lineno, thing.attr, f"{text}; for all of them, write while True: around it"


def _is_unbounded(parents: Sequence[ast.AST]) -> bool:
    """Whether a call is a wait without a limit: a statement or an awaited value, outside of any `timeout`."""
    return isinstance(parents[-1], (ast.Await, ast.Expr)) and not _is_limited(parents)


def _is_limited(parents: Sequence[ast.AST]) -> bool:
    return any(isinstance(parent, ast.AsyncWith) for parent in parents)


def _decorators(method: FunctionNode | None) -> set[str]:
    found = method.decorator_list if method is not None else []
    return {last_name(d.func if isinstance(d, ast.Call) else d) for d in found}


def _is_filled_again(definition: ast.ClassDef, source: ClassSource, name: str) -> bool:
    """Whether handlers that run again and again put items into a queue that one line takes from."""
    uses = source.uses(name)
    values = [use.value for use in uses if use.kind == "assigned"]
    if [last_name(v.func) if isinstance(v, ast.Call) else "" for v in values] != ["Queue"] or source.foreign(name):
        return False
    again = {m.name for m in definition.body if isinstance(m, FunctionNode) and _decorators(m) & _REPEATED}
    others = [use for use in uses if use.kind != "assigned"]
    taken = [use for use in others if use.name in ("get", "get_nowait")]
    filled = [use for use in others if use.name in ("put", "put_nowait") and use.method in again]
    return len(taken) == 1 and bool(filled) and all(use.kind == "called" for use in others)


def _of_object(source: ClassSource, name: str, method: str) -> str:
    """Return the reason why the wait for an object never ends; empty if that is not known."""
    uses = source.uses(name)
    values = [use.value for use in uses if use.kind == "assigned" and not _is_none(use.value)]
    made = {last_name(value.func) if isinstance(value, ast.Call) else "" for value in values}
    kind = _KINDS.get(made.pop()) if len(made) == 1 else None
    if kind is None or method != kind.waits or source.foreign(name):
        return ""
    others = [use for use in uses if use.kind not in ("assigned", *(() if method else ("read",)))]
    if any(use.kind != "called" or use.name not in kind.harmless for use in others):
        return ""
    return f"nothing {kind.does} it; call self.{name}.{kind.ends} in another handler"


def _is_none(value: ast.AST | None) -> bool:
    return isinstance(value, ast.Constant) and value.value is None


def _polled(test: ast.expr) -> tuple[str, tuple[object, ...]]:
    """Return the attribute that a loop polls, and the values with which the loop goes on."""
    match test:
        case ast.Compare(left=ast.Attribute() as read, ops=[ast.Is()], comparators=[ast.Constant(value=None)]):
            return (read.attr, (None,)) if is_own(read) else ("", ())
        case ast.UnaryOp(op=ast.Not(), operand=ast.Attribute() as read):
            return (read.attr, (False, None, 0)) if is_own(read) else ("", ())
    return "", ()


def _stays(cls: type, source: ClassSource, name: str, staying: tuple[object, ...]) -> bool:
    """Whether an attribute is only ever set to some values."""
    uses = source.uses(name)
    if source.foreign(name) or any(use.kind not in ("assigned", "read") for use in uses):
        return False
    values = [_value(use.value) for use in uses if use.kind == "assigned"]
    if not any(use.method == "__init__" for use in uses if use.kind == "assigned"):
        values.append(inspect.getattr_static(cls, name, _MISSING))
    return all(any(value is one for one in staying) for value in values)


def _value(expression: ast.expr | None) -> object:
    return expression.value if isinstance(expression, ast.Constant) else _MISSING


def _may_leave(loop: ast.While | ast.AsyncFor) -> bool:
    return any(isinstance(node, (ast.Break, ast.Return, ast.Raise)) for node in nodes_in(loop))
