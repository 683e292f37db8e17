"""Lost updates: a handler reads `self.total`, awaits, and sets it from the old value while another changes it.

Only sequences that lose a change for certain are told: one handler computes the new value from what it has read before
an `await`, another adds to the attribute whenever it runs, and no group, lock or second look keeps them apart. Others
are found by `--races` while a node runs.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.bindings import bindings_of
from graphflow.analysis.syntax import FunctionNode, nodes_in, walk
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import Group
from graphflow.runtime.declarations.handlers import Handler

_CONCURRENT = ("subscription", "service")
"""Handlers that run at the same time as themselves in a group without a limit of 1."""
_STOPPING = ("cancel", "stop", "acquire", "pause", "destroy")
"""Methods by which a handler may keep others from running."""


class _Write(NamedTuple):
    """An assignment of an attribute from a value that was read before an `await`."""

    attribute: str
    line: int
    awaited: int
    """The line of the `await`."""


def lost_updates(cls: type, owner: type, definition: ast.ClassDef, module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines of a class that lose an update; each comes with its correction.

    Args:
        cls: The class of the nodes.
        owner: The class itself, or the parent of it that `definition` defines.
    """
    handlers = {
        name: replace(handler, group=_group_of(cls, handler)) for name, handler in declared.handlers(cls).items()
    }
    methods = {
        method.name: method
        for method in definition.body
        if isinstance(method, FunctionNode)
        and method.name in handlers
        and getattr(cls, method.name) is vars(owner).get(method.name)  # a subclass may override it
    }
    for name, method in methods.items():
        if not isinstance(method, ast.AsyncFunctionDef) or _keeps_others_out(method):
            continue
        for write in _writes(method):
            if not _is_number(write.attribute, definition, module):
                continue
            shown = f"self.{write.attribute}"
            why = f"{shown} is set from a value that was read before the await in line {write.awaited}"
            if (other := _other(name, write.attribute, methods, handlers)) is not None:
                other_name, line = other
                way = f"read {shown} after the await, or put both in one group: {_group(handlers[name])} on both"
                yield write.line, f"{why}, so that a change by {other_name} (line {line}) meanwhile is lost; {way}"
            elif _overlaps_itself(handlers[name]):
                way = f"read {shown} after the await, or give its group a limit of 1"
                yield write.line, f"{why}, so that a change by another run of {name} meanwhile is lost; {way}"


def _group_of(cls: type, handler: Handler) -> Group | None:
    default: Group | None = getattr(cls, "default_group", None)
    return None if handler.kind == "task" else handler.group or default


def _group(handler: Handler) -> str:
    group = handler.group
    return (
        f"group={group.name}"
        if group is not None and group.limit == 1
        else "state = Group(1) in the class, group=state"
    )


def _keeps_others_out(method: FunctionNode) -> bool:
    """Whether a method holds a lock or a group of its own, or stops other handlers."""
    for node, _ in walk(method):
        match node:
            case ast.With() | ast.AsyncWith():
                return True
            case ast.Call(func=ast.Attribute(attr=way)) if way in _STOPPING:
                return True
    return False


def _is_number(attribute: str, definition: ast.ClassDef, module: ast.Module) -> bool:
    """Whether a class starts an attribute with a number, which an addition replaces; it changes a list in place."""
    example = ast.Attribute(ast.Name("self", ast.Load()), attribute, ast.Load())
    values = [value.expression for value in bindings_of(module).of(example, [module, definition])]
    constants = [value.value for value in values if isinstance(value, ast.Constant)]
    return any(isinstance(value, (int, float)) and not isinstance(value, bool) for value in constants)


def _other(
    name: str, attribute: str, methods: dict[str, FunctionNode], handlers: dict[str, Handler]
) -> tuple[str, int] | None:
    """Return another handler that adds to an attribute whenever it runs, and may run at the same time; and the line."""
    group = handlers[name].group
    for other, method in methods.items():
        is_exclusive = group is not None and handlers[other].group is group and group.limit == 1
        if other == name or is_exclusive:
            continue
        for statement in method.body:
            if any(isinstance(node, (ast.Return, ast.Raise, ast.Await)) for node in nodes_in(statement)):
                break
            if isinstance(statement, ast.AugAssign) and _is(statement.target, attribute):
                return other, statement.lineno
    return None


def _overlaps_itself(handler: Handler) -> bool:
    return handler.kind in _CONCURRENT and handler.group is not None and handler.group.limit != 1


def _writes(method: ast.AsyncFunctionDef) -> Iterator[_Write]:
    """Yield the assignments of a method from old values, each found within one block of statements."""
    attributes = {
        node.attr
        for node, _ in walk(method, into_functions=False)
        if isinstance(node, ast.Attribute) and is_own(node) and isinstance(node.ctx, ast.Store)
    }
    for node, _ in walk(method, into_functions=False):
        for block in (getattr(node, name, None) for name in ("body", "orelse", "finalbody")):
            if isinstance(block, list):
                for attribute in sorted(attributes):
                    yield from _in_block(block, attribute)


def _in_block(block: Sequence[ast.stmt], attribute: str) -> Iterator[_Write]:
    old: dict[str, int] = {}
    """Names with values that were computed from the attribute, with the line of an `await` since then, or 0."""
    copies = set[str]()
    """Names with the value itself, which may be kept to restore it."""
    for statement in block:
        match statement:
            case ast.AugAssign(target=target, value=value) if _is(target, attribute):
                if (awaited := _first_await(value)) is not None:
                    yield _Write(attribute, statement.lineno, awaited.lineno)
                old.clear()
                continue
            case ast.Assign(targets=[target], value=value) if _is(target, attribute):
                is_restored = isinstance(value, ast.Name) and value.id in copies
                if (line := _awaited(value, attribute, old)) is not None and not is_restored:
                    yield _Write(attribute, statement.lineno, line)
                old.clear()
                continue
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                since = _since(value, attribute, old)
                if (awaited := _first_await(value)) is not None:
                    old = {known: line or awaited.lineno for known, line in old.items()}
                old.pop(name, None)
                copies.discard(name)
                if since is not None:
                    old[name] = since
                    copies |= {name} if _is(value, attribute) else set()
                continue
        if any(_is(node, attribute) for node in nodes_in(statement)):
            old.clear()  # the attribute is looked at again
        stored = {n.id for n in nodes_in(statement) if isinstance(n, ast.Name) and not isinstance(n.ctx, ast.Load)}
        awaited = _first_await(statement)
        old = {known: line or (awaited.lineno if awaited else 0) for known, line in old.items() if known not in stored}


def _awaited(value: ast.expr, attribute: str, old: dict[str, int]) -> int | None:
    """Return the line of the `await` between a read of an attribute and the use of the value; None if there is none."""
    if any(_is(node, attribute) for node in nodes_in(value)):
        return _since(value, attribute, {}) or None
    return _since(value, attribute, old) or None


def _since(value: ast.expr, attribute: str, old: dict[str, int]) -> int | None:
    """Return the line of an `await` after an attribute was read for a value, or 0; None if it does not depend on it."""
    found: list[int] = []
    awaits = [node for node, _ in walk(value, into_functions=False) if isinstance(node, ast.Await)]
    for node, parents in walk(value, into_functions=False):
        if any(isinstance(parent, (ast.Compare, ast.IfExp, ast.BoolOp, ast.Lambda)) for parent in parents):
            continue
        after = [a.lineno for a in awaits if _end(a) > (getattr(node, "lineno", 0), getattr(node, "col_offset", 0))]
        if _is(node, attribute):
            found.append(after[0] if after else 0)
        elif isinstance(node, ast.Name) and node.id in old:
            found.append(old[node.id] or (after[0] if after else 0))
    return max(found) if found else None


def _end(node: ast.expr) -> tuple[int, int]:
    return node.end_lineno or 0, node.end_col_offset or 0


def _is(node: ast.AST, attribute: str) -> bool:
    return is_own(node) and node.attr == attribute


def _first_await(node: ast.AST) -> ast.Await | None:
    found = (inner for inner, _ in walk(node, into_functions=False) if isinstance(inner, ast.Await))
    return next(found, None)
