"""Publishers that a program for rclpy makes and never uses, so that it publishes nothing."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_OTHER_WAYS = {"getattr", "vars", "__dict__", "attrgetter", "publishers"}
"""Names in a file that may use a publisher in another way."""


def unused_publishers(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines that make such a publisher; each comes with the attribute that may be meant.

    Only in a file with a program: other files may use the publishers of a file without one.
    """
    nodes = nodes_in(module)
    names = {node.id for node in nodes if isinstance(node, ast.Name)}
    attributes = [node for node in nodes if isinstance(node, ast.Attribute)]
    has_main = any(isinstance(item, FunctionNode) and item.name == "main" for item in module.body)
    if not has_main or _OTHER_WAYS & (names | {node.attr for node in attributes}):
        return
    used = {node.attr for node in attributes if not isinstance(node.ctx, ast.Store)}
    texts = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    set_ = {node.attr for node in attributes if isinstance(node.ctx, ast.Store)}
    publishing = [node.value for node in attributes if node.attr == "publish" and is_own(node.value)]
    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Attribute(attr=name) as target], value=ast.Call(func=made)) if (
                is_own(target) and last_name(made) == "create_publisher" and name not in used | texts
            ):
                way = f"call self.{name}.publish(...)"
                if other := next((one for one in publishing if one.attr not in set_), None):
                    way = f"line {other.lineno} has self.{other.attr}, which nothing sets: write self.{name} there"
                yield node.lineno, f"self.{name} publishes nothing, since no other line uses it: {way}"
