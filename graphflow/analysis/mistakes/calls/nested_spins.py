"""Callbacks that spin their own node, `rclpy.spin_once(self)`: the node already spins, and waits for the callback."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.mistakes.calls.called_early import TAKERS
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in


def nested_spins(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines of callbacks that spin `self` once; each comes with what happens.

    One that spins it for ever keeps its group, which is reported as it happens.
    """
    calls = [node for node in nodes_in(module) if isinstance(node, ast.Call)]
    given = [(call, TAKERS[last_name(call.func)]) for call in calls if last_name(call.func) in TAKERS]
    callbacks = {last_name(call.args[at]) for call, at in given if len(call.args) > at}
    callbacks |= {last_name(k.value) for call, _ in given for k in call.keywords if k.arg == "callback"}
    for method in nodes_in(module):
        if not isinstance(method, FunctionNode) or method.name not in callbacks:
            continue
        for node in nodes_in(method):
            match node:
                case ast.Call(
                    func=ast.Attribute(value=ast.Name("rclpy"), attr="spin_once"), args=[ast.Name("self"), *_]
                ):
                    text = f"rclpy.spin_once(self) in the callback {method.name} waits for callbacks of this node"
                    way = f"which wait for {method.name}: leave it out, since main spins the node"
                    yield node.lineno, f"{text}, {way}"
