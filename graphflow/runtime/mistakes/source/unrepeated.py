"""Tasks that end with a wait, as the body of a loop does: a task runs once, unlike a timer."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import last_name, nodes_in
from graphflow.runtime.declarations import declared

_LOOPS = (ast.While, ast.For, ast.AsyncFor)


def unrepeated(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the tasks of a class that have no loop and end with a sleep; each comes with a sentence."""
    handlers = declared.handlers(cls)
    for method in definition.body:
        if not isinstance(method, ast.AsyncFunctionDef) or any(isinstance(node, _LOOPS) for node in nodes_in(method)):
            continue
        handler = handlers.get(method.name)
        if handler is None or handler.kind != "task":
            continue
        match method.body:
            case [_, *_, ast.Expr(value=ast.Await(value=ast.Call(func=function, args=[seconds]))) as last]:
                if last_name(function) == "sleep":
                    name, period = method.name, ast.unparse(seconds)
                    text = f"{name} runs once, and ends after this sleep; write @timer({period}) above it in place of"
                    yield last.lineno, f"{text} @task, without the sleep, or put its lines into while True:"
