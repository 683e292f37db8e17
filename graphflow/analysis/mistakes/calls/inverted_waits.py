"""Loops that wait while a service is there: `while self.client.wait_for_service():`, where `while not` was meant."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import last_name, nodes_in

_WAITS = ("wait_for_service", "wait_for_server")
_LOGS = ("debug", "info", "warn", "warning", "error", "print", "sleep")


def inverted_waits(module: ast.AST) -> Iterator[tuple[int, str]]:
    """Find loops that only log or pause for as long as such a wait succeeds; each comes with its correction."""
    for node in nodes_in(module):
        match node:
            case ast.While(test=ast.Call(func=function) as test, body=body) if last_name(function) in _WAITS:
                if all(map(_only_tells, body)):
                    text = f"this loop goes on for as long as {ast.unparse(function)} finds a server"
                    yield node.lineno, f"{text}; write while not {ast.unparse(test)}:"


def _only_tells(statement: ast.stmt) -> bool:
    match statement:
        case ast.Expr(value=ast.Call(func=function)):
            return last_name(function) in _LOGS
    return isinstance(statement, ast.Pass)
