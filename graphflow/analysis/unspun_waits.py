"""Waits of an rclpy program's own functions, such as `main`, for what only a spin would bring, while nothing spins.

A file in which a thread, a process or a coroutine may spin, or a function of its own, is left out.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping

from graphflow.analysis.deadlock_check import Finding, Grade
from graphflow.analysis.rclpy_futures import dotted, polled_futures
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk
from graphflow.errors import Place

_BESIDE = re.compile(r"Thread|Timer|Process|Pool|run_in_executor|create_task|ensure_future|gather|asyncio")
"""Names of what runs beside a function."""
_MAKERS = ("create_client", "create_rate")
_ASKING = ("call_async", "send_goal_async", "get_result_async", "cancel_goal_async")
"""Methods that return a future, which is done only after a spin."""
_IDLE = ("sleep", "print", "ok", "done", "info", "debug", "warn", "warning", "error", "get_logger")
"""Functions that a loop may call and that spin nothing."""


def unspun_waits(module: ast.Module, file: str) -> Iterator[Finding]:
    """Find the waits in the functions outside of classes; each run that comes to one stays there."""
    for node in nodes_in(module):
        match node:
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.alias(name=name) if _BESIDE.search(name):
                return
    for function in module.body:
        if isinstance(function, ast.FunctionDef):
            yield from _of(function, file)


def _of(function: ast.FunctionDef, file: str) -> Iterator[Finding]:
    made = _made(function)
    for node, parents in walk(function, into_functions=False):
        if isinstance(node, (ast.While, ast.Call)) and (text := _text(node, made)):
            is_sure = not any(isinstance(parent, (ast.If, ast.Try, ast.ExceptHandler)) for parent in parents)
            grade: Grade = "CERTAIN" if is_sure else "IF THIS BRANCH RUNS"
            yield Finding(grade, Place(file, node.lineno), f"{function.name}: {text}")


def _text(node: ast.While | ast.Call, made: Mapping[str, str]) -> str:
    """Describe the wait of a loop or of a call, with its remedy; "" if it is none.

    Args:
        made: See `_made`.
    """
    match node:
        case ast.While(test=test) if all(name in _IDLE for name in _called(node)):
            future = next((name for name in map(dotted, polled_futures(test)) if made.get(name) in _ASKING), "")
            way = f"write rclpy.spin_until_future_complete(node, {future})"
            return f"the loop waits for {future}, and nothing spins meanwhile: {way}" if future else ""
        case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="call")) if made.get(name) == "create_client":
            way = f"future = {name}.call_async(request), then rclpy.spin_until_future_complete(node, future)"
            return f"{name}.call waits for the answer, and nothing spins meanwhile: {way}"
        case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="sleep")) if made.get(name) == "create_rate":
            thread = "Thread(target=rclpy.spin, args=(node,), daemon=True).start()"
            way = f"make a timer in its place, or spin in a thread before: {thread}"
            return f"{name}.sleep waits for a timer, and nothing spins meanwhile: {way}"
    return ""


def _made(function: FunctionNode) -> dict[str, str]:
    """Return the names of a function's clients, rates and futures, with the method that makes each."""
    found: dict[str, str] = {}
    for node in nodes_in(function):
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=made)) if last_name(made) in (*_MAKERS, *_ASKING):
                found[dotted(target)] = last_name(made)
    return found


def _called(loop: ast.While) -> Iterator[str]:
    return (last_name(node.func) for node in nodes_in(loop) if isinstance(node, ast.Call))
