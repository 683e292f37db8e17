"""Futures of a goal's answer or result that are cancelled in place of the goal, which goes on."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.bindings import bindings_of
from graphflow.analysis.syntax import last_name, nodes_in, walk

_SOURCES = ("get_result_async", "send_goal_async")


def cancelled_futures(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines that cancel such a future in a file that never cancels a goal; each comes with its correction."""
    called = {node.attr for node in nodes_in(module) if isinstance(node, ast.Attribute)}
    if called.isdisjoint(_SOURCES) or called & {"cancel_goal_async", "cancel_goal"}:
        return
    bindings = bindings_of(module)
    for node, parents in walk(module):
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Name() | ast.Attribute() as future, attr="cancel"), args=[]):
                values = [value.expression for value in bindings.of(future, parents)]
                made = [v for v in values if isinstance(v, ast.Call) and last_name(v.func) in _SOURCES]
                if made and all(v in made or (isinstance(v, ast.Constant) and v.value is None) for v in values):
                    text = f"{ast.unparse(future)}.cancel() ends only the wait, and the goal goes on; keep the goal"
                    yield node.lineno, f"{text} handle, and write goal_handle.cancel_goal_async()"
