"""Actions in threads that never look whether they are cancelled: a thread cannot be interrupted from outside."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import nodes_in
from graphflow.runtime.declarations import declared

_LOOPS = (ast.While, ast.For)


def uncancelled(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the loops of such actions, which give their goal to no other function; each comes with a sentence."""
    handlers = declared.handlers(cls)
    for method in definition.body:
        handler = handlers.get(method.name) if isinstance(method, ast.FunctionDef) else None
        if handler is None or not isinstance(method, ast.FunctionDef) or handler.kind != "action" or not handler.thread:
            continue
        nodes = nodes_in(method)
        loop = next((node for node in nodes if isinstance(node, _LOOPS)), None)
        if loop is None or len(method.args.args) < 2:
            continue
        goal = method.args.args[1].arg
        is_looked_at = any(isinstance(n, ast.Attribute) and n.attr == "is_cancel_requested" for n in nodes)
        given = [value for n in nodes if isinstance(n, ast.Call) for value in (*n.args, *(k.value for k in n.keywords))]
        if not is_looked_at and not any(isinstance(value, ast.Name) and value.id == goal for value in given):
            text = f"cancelling does not end {method.name}, since it runs in a thread: in the loop write"
            yield loop.lineno, f"{text} if {goal}.is_cancel_requested: return {handler.type.__name__}.Result()"
