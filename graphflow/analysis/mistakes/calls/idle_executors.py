"""Executors that a program for rclpy makes in vain: `rclpy.spin(node)` does not use them, or they have no node."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_CLASSES = ("SingleThreadedExecutor", "MultiThreadedExecutor", "EventsExecutor")
"""The classes of rclpy's executors."""


def idle_executors(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the calls of `rclpy.spin` beside an executor that only gets nodes, and spins of one that gets none."""
    for function in nodes_in(module):
        if isinstance(function, FunctionNode):
            yield from _empty(function)
            idle = _idle(function)
            for node in nodes_in(function):
                match node:
                    case ast.Call(func=spin, args=[given], keywords=[]) if idle and ast.unparse(spin) == "rclpy.spin":
                        name, kind = next(iter(idle.items()))
                        text = f"rclpy.spin does not use the {kind} in {name}"
                        yield node.lineno, f"{text}: write rclpy.spin({ast.unparse(given)}, {name})"


def _empty(function: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield the spins of executors that a function makes, and does nothing else with."""
    loads = [n.id for n in nodes_in(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)]
    for name in _made(function):
        spins, others = list[int](), loads.count(name)
        for node in nodes_in(function):
            match node:
                case ast.Attribute(value=ast.Name(id=owner), attr="spin" | "shutdown" as word) if owner == name:
                    others -= 1
                    spins += [node.lineno] if word == "spin" else []
        for line in spins if not others else ():
            yield line, f"{name} has no node: write {name}.add_node(...) before it spins"


def _idle(function: ast.AST) -> dict[str, str]:
    """Return the names of the executors that a function makes and never spins, with their classes."""
    added: set[ast.AST] = set()
    for node in nodes_in(function):
        match node:
            case ast.Attribute(value=ast.Name() as owner, attr="add_node" | "remove_node" | "shutdown"):
                added.add(owner)
    loads = [n for n in nodes_in(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)]
    used = {name.id for name in loads if name not in added}
    return {name: kind for name, kind in _made(function).items() if name not in used}


def _made(function: ast.AST) -> dict[str, str]:
    """Return the names of the executors that a function makes, with their classes."""
    made: dict[str, str] = {}
    for node in nodes_in(function):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=cls)) if last_name(cls) in _CLASSES:
                made[name] = last_name(cls)
    return made
