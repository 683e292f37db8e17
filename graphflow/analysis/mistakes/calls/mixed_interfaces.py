"""rclpy nodes with graphflow's declarations, which only graphflow's own Node reads."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import nodes_in

_INSTEAD = {
    "timer": "self.create_timer(...)",
    "subscription": "self.create_subscription(...)",
    "service": "self.create_service(...)",
    "action": "ActionServer(self, ...)",
    "task": "self.create_timer(...)",
    "Param": "self.declare_parameter(...)",
    "Publisher": "self.create_publisher(...)",
    "Subscription": "self.create_subscription(...)",
    "Client": "self.create_client(...)",
    "ActionClient": "ActionClient(self, ...) of rclpy.action",
}
"""rclpy's equivalents of graphflow's declarations."""


def mixed_interfaces(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find graphflow's declarations in classes that derive from rclpy's Node; each comes with a sentence."""
    imported = {
        alias.asname or alias.name: (found.module or "", alias.name)
        for found in nodes_in(module)
        if isinstance(found, ast.ImportFrom)
        for alias in found.names
    }
    native = {used: name for used, (source, name) in imported.items() if source == "graphflow" and name in _INSTEAD}
    nodes = {used for used, (source, name) in imported.items() if source.split(".")[0] == "rclpy" and "Node" in name}
    for cls in nodes_in(module) if native else ():
        if not isinstance(cls, ast.ClassDef) or not any(_is_rclpys(base, nodes) for base in cls.bases):
            continue
        for item in cls.body:
            for call in _declarations(item):
                if isinstance(call.func, ast.Name) and call.func.id in native:
                    name = native[call.func.id]
                    text = f"graphflow's {name} has no effect in a node of rclpy: write {_INSTEAD[name]} in __init__,"
                    yield call.lineno, f"{text} or derive {cls.name} from graphflow.Node"


def _is_rclpys(base: ast.expr, nodes: set[str]) -> bool:
    return (isinstance(base, ast.Name) and base.id in nodes) or ast.unparse(base) == "rclpy.node.Node"


def _declarations(item: ast.stmt) -> list[ast.Call]:
    """Return the calls that decorate a method, or whose results a class attribute is."""
    match item:
        case ast.FunctionDef(decorator_list=found) | ast.AsyncFunctionDef(decorator_list=found):
            return [call for call in found if isinstance(call, ast.Call)]
        case ast.Assign(value=ast.Call() as call) | ast.AnnAssign(value=ast.Call() as call):
            return [call]
    return []
