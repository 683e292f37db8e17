"""Fields that go from 0 to 1 and are compared with percentages."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import nodes_in

_LEAST_PERCENT = 2


def wrong_scale(module: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines that compare a BatteryState's `percentage` with a percentage; each comes with its correction."""
    nodes = nodes_in(module)
    if not any(isinstance(node, ast.Name) and node.id == "BatteryState" for node in nodes):
        return
    for node in nodes:
        match node:
            case ast.Compare(left=left, comparators=[right]):
                for field, limit in ((left, right), (right, left)):
                    match field, limit:
                        case ast.Attribute(attr="percentage"), ast.Constant(value=int(number) | float(number)):
                            if number >= _LEAST_PERCENT:
                                text = f"{ast.unparse(field)} goes from 0.0 to 1.0; for {number:g} % write"
                                yield node.lineno, f"{text} {number / 100:g}"
