"""Statements after `rclpy.spin(node)` that are meant to run while the node does, or when a future is done."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, blocks, last_name, nodes_in

_SENDS = {"publish", "call_async", "call", "send_goal", "send_goal_async", "create_timer", "create_subscription"}
_IS_LAST = re.compile(r"stop|halt|brake|shut|close|clean|destroy|finish|exit|quit|save|on_|end|reset|land|disarm")
"""Methods that a program calls on purpose when it ends."""


def after_spin(module: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines after `rclpy.spin` that send or create something, or read a result; each comes with a sentence."""
    sending = {
        method.name
        for method in nodes_in(module)
        if isinstance(method, FunctionNode) and any(_sends(node) for node in nodes_in(method))
    }
    for node in nodes_in(module):
        for block in blocks(node):
            yield from _after(block, sending)


def _after(body: list[ast.stmt], sending: set[str]) -> Iterator[tuple[int, str]]:
    spun = next((i for i, s in enumerate(body) if _spins(s)), None)
    if spun is None:
        return
    spin = body[spun]
    line, node = spin.lineno, next((ast.unparse(arg) for arg in _spun(spin)), "node")
    yield from _destroyed(body[:spun], spin)
    futures = {name for statement in body[:spun] for name in _assigned(statement)}
    for statement in body[spun + 1 :]:
        if any(isinstance(part, ast.Call) and ast.unparse(part.func) == "rclpy.init" for part in nodes_in(statement)):
            return  # a callback has ended the first part
        if read := next((name for name in _results(statement) if name in futures), None):
            text = f"{read}.result() runs only after Ctrl-C, since spin (line {line}) returns then"
            yield statement.lineno, f"{text}; write rclpy.spin_until_future_complete({node}, {read}) in line {line}"
            return
        if _spins(statement):
            text = f"{ast.unparse(statement)} runs only after Ctrl-C, since spin (line {line}) returns then"
            way = "executor = SingleThreadedExecutor(), executor.add_node(node) for each, executor.spin()"
            yield statement.lineno, f"{text}; spin all nodes together: {way}"
            return
        match statement:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=owner, attr=name) as function) as call):
                is_sent = _sends(call) or (isinstance(owner, ast.Name) and name in sending)
                if is_sent and not _IS_LAST.match(name):
                    text = f"{ast.unparse(function)} runs only after Ctrl-C, since spin (line {line})"
                    yield statement.lineno, f"{text} returns then; call it before spin, or in a callback of a timer"


def _destroyed(before: list[ast.stmt], spin: ast.stmt) -> Iterator[tuple[int, str]]:
    """Yield the line that destroys the node which a spin is given."""
    spun = {node.id for node in nodes_in(spin) if isinstance(node, ast.Name)}
    for statement in before:
        match statement:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id=node), attr="destroy_node"))):
                if node in spun:
                    text = f"{node}.destroy_node() ends the node before spin (line {spin.lineno}), which calls nothing"
                    yield statement.lineno, f"{text}; destroy it after spin"


def _assigned(statement: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement binds to what a call returns, unless that is the future of a thread."""
    match statement:
        case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=function)):
            if last_name(function) not in ("submit", "run_coroutine_threadsafe"):
                yield name


def _results(statement: ast.stmt) -> Iterator[str]:
    """Yield the names whose `result()` a statement calls."""
    for node in nodes_in(statement):
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="result"), args=[]):
                yield name


def _spins(statement: ast.stmt) -> bool:
    match statement:
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="rclpy"), attr="spin"))):
            return True
    return False


def _spun(spin: ast.stmt) -> list[ast.expr]:
    """Return the arguments of a spin: the node, and perhaps an executor."""
    match spin:
        case ast.Expr(value=ast.Call(args=arguments)):
            return arguments
    return []


def _sends(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and last_name(node.func) in _SENDS
