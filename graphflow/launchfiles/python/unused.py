"""Unused actions of launch files: `node = Node(...)` without `node` in the description, or `Node(...)` alone."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

from graphflow.launchfiles.python.names import NAMES

_ACTIONS = {name for module in ("launch.actions", "launch_ros.actions") for name in NAMES[module].split()}


class Unused(NamedTuple):
    """An action that no description contains."""

    line: int
    message: str
    argument: str
    """The name of the launch argument that it declares; empty for other actions."""


def unused_actions(tree: ast.Module) -> Iterator[Unused]:
    """Yield the actions assigned to a name that the file never reads, and those that nothing takes."""
    read = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Store)}
    # The file may collect its actions by name.
    if "locals" in read or "globals" in read:
        return
    for function in ast.walk(tree):
        if not isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        shared = {
            name for node in ast.walk(function) if isinstance(node, ast.Global | ast.Nonlocal) for name in node.names
        }
        for node in ast.walk(function):
            match node:
                case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=func) as call) if (
                    name not in read | shared and _kind(func) in _ACTIONS
                ):
                    yield Unused(
                        node.lineno,
                        f"{name} is in no description: write LaunchDescription([..., {name}])",
                        _argument(call),
                    )
                case ast.Expr(value=ast.Call(func=func) as call) if _kind(func) in _ACTIONS:
                    way = "put it into LaunchDescription([...])"
                    if function.name != "generate_launch_description":  # that of an OpaqueFunction, for example
                        way = f"write return [{_kind(func)}(...)]"
                    text = f"this {_kind(func)} is in no description: {way}"
                    yield Unused(node.lineno, text, _argument(call))


def _kind(called: ast.expr) -> str:
    """Return the name of a class, without its module."""
    return ast.unparse(called).rpartition(".")[2]


def _argument(call: ast.Call) -> str:
    """Return the name of the argument that a call declares; empty for another action."""
    if _kind(call.func) != "DeclareLaunchArgument":
        return ""
    named = [keyword.value for keyword in call.keywords if keyword.arg == "name"]
    match [*call.args[:1], *named]:
        case [ast.Constant(value=str(name))]:
            return name
    return ""
