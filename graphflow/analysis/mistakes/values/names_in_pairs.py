"""Names that are looked for among pairs: `"/pose" in self.get_topic_names_and_types()` is never true."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.bindings import bindings_of
from graphflow.analysis.syntax import last_name, nodes_in, walk

_LISTS = {"get_topic_names_and_types", "get_service_names_and_types", "get_node_names_and_namespaces"}
"""Methods of rclpy's nodes that return lists of pairs, whose first item is a name."""


def names_in_pairs(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines that look for a text in such a list; each comes with its correction."""
    if _LISTS.isdisjoint(node.attr for node in nodes_in(module) if isinstance(node, ast.Attribute)):
        return
    bindings = bindings_of(module)
    for node, parents in walk(module):
        match node:
            case ast.Compare(left=name, ops=[ast.In() | ast.NotIn() as op], comparators=[among]):
                values = [value.expression for value in bindings.of(among, parents)] or [among]
                is_list = all(isinstance(v, ast.Call) and last_name(v.func) in _LISTS for v in values)
                if is_list and isinstance(name, (ast.Constant, ast.JoinedStr)):
                    word, shown = "not in" if isinstance(op, ast.NotIn) else "in", ast.unparse(among)
                    text = f"{shown} has pairs in it, which never equal {ast.unparse(name)}"
                    yield node.lineno, f"{text}; write {ast.unparse(name)} {word} dict({shown})"
