"""Definitions and assignments in a class that have no effect where they are.

Examples are a decorated handler inside another method, `_init_`, `goal.feedback = message`, and an `on_start` that
replaces its parent's, whose attributes are then missing.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_DECORATORS = {"timer", "subscription", "service", "action", "task"}
_METHODS = {"publish", "publish_feedback", "feedback", "succeed", "abort", "canceled", "send_goal_async", "call_async"}
_METHODS |= {"sendTransform"}
"""Methods to which beginners assign a message."""
_LEVELS = ("debug", "info", "warn", "warning", "error", "fatal")
_DUNDERS = {"init": "__init__", "int": "__init__", "inti": "__init__", "main": "__main__"}
_HOOKS = ("on_start", "on_configure", "on_activate")


def misplaced(definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the lines of such definitions and assignments of a class; each comes with a sentence."""
    for method in definition.body:
        if isinstance(method, FunctionNode):
            yield from _misspelt(method)
            yield from _inside(method)
    yield from replaced_methods(definition)


def _misspelt(method: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[tuple[int, str]]:
    meant = _DUNDERS.get(method.name.strip("_"))
    if meant == "__init__" and method.name.startswith("_") and method.name not in ("__init__", "__int__", "_int"):
        yield method.lineno, f"{method.name} is never called: write {meant}, with two underscores on each side"


def _inside(method: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[tuple[int, str]]:
    for node in nodes_in(method):
        if node is method or not isinstance(node, FunctionNode):
            continue
        for decorator in node.decorator_list:
            called = decorator.func if isinstance(decorator, ast.Call) else decorator
            if isinstance(called, ast.Name) and called.id in _DECORATORS:
                text = f"@{called.id} has no effect inside {method.name}: move {node.name} into the class body"
                yield node.lineno, text


def replaced_methods(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find assignments to methods that are to be called: `self.pub.publish = message`."""
    made = {target.id for node in nodes_in(code) for target in _made(node)}
    for node in nodes_in(code):
        if not isinstance(node, ast.Assign) or _is_function(node.value, made):
            continue
        for target in node.targets:
            is_called = isinstance(target, ast.Attribute) and (target.attr in _METHODS or _is_of_logger(target))
            if isinstance(target, ast.Attribute) and is_called and not is_own(target):
                shown = ast.unparse(target)
                if target.attr == "feedback" and not _is_goal(target.value):
                    continue
                yield node.lineno, f"{shown} is a method: write {shown}({ast.unparse(node.value)[:60]})"


def _is_goal(owner: ast.expr) -> bool:
    return isinstance(owner, ast.Name) and "goal" in owner.id


def _made(node: ast.AST) -> Iterator[ast.Name]:
    """Yield the names that an assignment binds to an object of a class, such as a message."""
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and last_name(node.value.func)[:1].isupper():
        yield from (target for target in node.targets if isinstance(target, ast.Name))


def _is_of_logger(target: ast.Attribute) -> bool:
    match target.value:
        case ast.Call(func=function):
            return target.attr in _LEVELS and last_name(function) == "get_logger"
        case ast.Attribute(attr="log") as log:
            return target.attr in _LEVELS and is_own(log)
    return False


def _is_function(value: ast.expr, made: set[str]) -> bool:
    """Whether a value may stand for a method, as in a test: a function, or the result of a factory.

    Args:
        made: Names of objects that are none.
    """
    if isinstance(value, ast.Name):
        return value.id not in made
    return isinstance(value, ast.Lambda) or (isinstance(value, ast.Call) and "ock" in last_name(value.func))
