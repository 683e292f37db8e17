"""Waits in `on_start` for what only a handler of the node sets, and handlers run when `on_start` has returned.

A running node that waits so is reported as a deadlock. Here the polling loops are found whose condition holds at the
start: `while self.pose is None: await self.clock.sleep(0.1)`.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from contextlib import suppress

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.class_source import ClassSource, Unknown
from graphflow.analysis.syntax import nodes_in, walk
from graphflow.runtime.declarations import declared

_MISSING = object()


def early_waits(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the lines of such waits in the `on_start` of a class; each comes with a sentence.

    Args:
        definition: The class statement.
    """
    for method in definition.body:
        if not isinstance(method, ast.AsyncFunctionDef) or method.name != "on_start":
            continue
        if any(
            node.attr.startswith(("create_", "spawn")) for node in nodes_in(method) if isinstance(node, ast.Attribute)
        ):
            continue  # it may start what ends the wait
        for node, _ in walk(method, into_functions=False):
            if isinstance(node, ast.While) and all(map(_only_pauses, node.body)):
                with suppress(Unknown):
                    yield from _forever(cls, node)


def _only_pauses(statement: ast.stmt) -> bool:
    """Whether a statement only sleeps, or logs."""
    match statement:
        case ast.Expr(value=ast.Await(value=ast.Call(func=function))):
            return ast.unparse(function) in ("self.clock.sleep", "asyncio.sleep")
        case ast.Expr(value=ast.Call(func=function)):
            return ast.unparse(function).startswith("self.log.")
    return isinstance(statement, ast.Pass)


def _forever(cls: type, loop: ast.While) -> Iterator[tuple[int, str]]:
    """Yield the line and the sentence for a loop that no code can end before `on_start` has returned.

    Raises:
        Unknown: Other code may end it.
    """
    attribute, is_none = _polled(loop.test)
    if not attribute:
        return
    source = ClassSource.of(cls)
    uses = source.uses(attribute)
    if source.foreign(attribute) or any(use.kind not in ("assigned", "read", "part", "called") for use in uses):
        raise Unknown
    changes = [use for use in uses if use.kind == "assigned"]
    first = [use.value for use in changes if use.method == "__init__"]
    setters = {use.method for use in changes} - {"__init__"}
    if "on_start" in setters or not setters or any(use.is_nested for use in changes) or len(first) > 1:
        return
    value = _value(first[0]) if first else inspect.getattr_static(cls, attribute, _MISSING)
    if value is _MISSING or callable(value) or (value is not None if is_none else bool(value)):
        return
    handlers = set(declared.handlers(cls))
    above = source.above(setters, handlers)
    if not above <= handlers | _callees(source, handlers) or above & {"on_start", "__init__", *declared.hooks(cls)}:
        return  # other code may call it, as a thread may
    if above & handlers:
        names = " and ".join(sorted(above & handlers))
        text = f"on_start waits for self.{attribute}, and {names}, which sets it, runs when on_start has returned"
        yield loop.lineno, f"{text}: move the wait into a @task"


def _polled(test: ast.expr) -> tuple[str, bool]:
    """Return the attribute that `self.x is None` or `not self.x` reads, and whether it is compared with None."""
    match test:
        case ast.Compare(left=ast.Attribute() as read, ops=[ast.Is()], comparators=[ast.Constant(value=None)]):
            return (read.attr, True) if is_own(read) else ("", True)
        case ast.UnaryOp(op=ast.Not(), operand=ast.Attribute() as read):
            return (read.attr, False) if is_own(read) else ("", False)
    return "", False


def _value(expression: ast.expr | None) -> object:
    return expression.value if isinstance(expression, ast.Constant) else _MISSING


def _callees(source: ClassSource, handlers: set[str]) -> set[str]:
    """Return the methods that handlers call, directly or through each other."""
    return {method for handler in handlers for method in source.below(handler)}
