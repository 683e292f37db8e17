"""Blocks of goals that wait for nothing, so that each goal is cancelled as soon as it is accepted."""

from __future__ import annotations

import ast
from functools import cache

from graphflow.analysis.syntax import nodes_in, syntax_of
from graphflow.errors import Place

_WAITS = (ast.Await, ast.AsyncFor, ast.AsyncWith, ast.Yield, ast.YieldFrom, ast.Raise)
"""Parts of a block that may wait, or that leave it on purpose."""
_reported: set[Place] = set()


def left_early(place: Place) -> str:
    """Return a complaint about the block that sends a goal in this line; "" if it may wait, or was reported.

    A block that waits for anything may be meant to cancel its goal then.
    """
    if place in _reported or not (name := _idle_block(place)):
        return ""
    _reported.add(place)
    result = f"await {name}.result()"
    return (
        f"{place}: the block ends at once, which cancels its goal; write {result} in the block, or send with "
        "detach=True to let the goal go on"
    )


@cache
def _idle_block(place: Place) -> str:
    """Return the name of the goal in a block that waits for nothing; "" if there is no such block in this line."""
    try:
        nodes = syntax_of(place.file).nodes
    except (OSError, SyntaxError, ValueError):  # no source to be read
        return ""
    for block in nodes:
        for item in block.items if isinstance(block, ast.AsyncWith) else ():
            call = item.context_expr
            if isinstance(call, ast.Call) and call.lineno <= place.line <= (call.end_lineno or call.lineno):
                assert isinstance(block, ast.AsyncWith)
                inside = (node for statement in block.body for node in nodes_in(statement))
                name = ast.unparse(item.optional_vars) if item.optional_vars else "goal"
                return "" if any(isinstance(node, _WAITS) for node in inside) else name
    return ""
