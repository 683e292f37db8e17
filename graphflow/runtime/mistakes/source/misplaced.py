"""Definitions and assignments in a class that have no effect where they are.

Examples are a decorated handler inside another method, `_init_`, `goal.feedback = message`, and an `on_start` that
replaces its parent's, whose attributes are then missing.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name
from graphflow.analysis.user_code import short_place
from graphflow.runtime.mistakes.source.shadowing import definition_of

_DECORATORS = {"timer", "subscription", "service", "action", "task"}
_METHODS = {"publish", "publish_feedback", "feedback", "succeed", "abort", "canceled", "send_goal_async", "call_async"}
"""Methods to which beginners assign a message."""
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
    for node in ast.walk(method):
        if node is method or not isinstance(node, FunctionNode):
            continue
        for decorator in node.decorator_list:
            called = decorator.func if isinstance(decorator, ast.Call) else decorator
            if isinstance(called, ast.Name) and called.id in _DECORATORS:
                text = f"@{called.id} has no effect inside {method.name}: move {node.name} into the class body"
                yield node.lineno, text


def replaced_methods(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find assignments to methods that are to be called: `self.pub.publish = message`."""
    for node in ast.walk(code):
        if not isinstance(node, ast.Assign) or _is_function(node.value):
            continue
        for target in node.targets:
            if isinstance(target, ast.Attribute) and target.attr in _METHODS and not is_own(target):
                shown = ast.unparse(target)
                if target.attr == "feedback" and not _is_goal(target.value):
                    continue
                yield node.lineno, f"{shown} is a method: write {shown}({ast.unparse(node.value)[:60]})"


def _is_goal(owner: ast.expr) -> bool:
    return isinstance(owner, ast.Name) and "goal" in owner.id


def _is_function(value: ast.expr) -> bool:
    """Whether a value may stand for a method, as in a test: a function, or the result of a factory."""
    return isinstance(value, (ast.Lambda, ast.Name)) or (isinstance(value, ast.Call) and "ock" in last_name(value.func))


def without_super(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find hooks of a class that replace those of a parent, whose attributes the parent's handlers then miss."""
    for method in definition.body:
        if not isinstance(method, FunctionNode) or method.name not in _HOOKS:
            continue
        if any(isinstance(node, ast.Attribute) and node.attr == method.name for node in ast.walk(method)):
            continue  # it calls its parent's
        parent = next((base for base in cls.__mro__[1:] if method.name in vars(base)), None)
        source = definition_of(parent) if parent is not None else None
        if parent is None or source is None:
            continue
        above, file = source
        lost = _set_by(above, method.name) - _set_by(definition, method.name) - _set_elsewhere(above)
        used = sorted(lost & _read_by(above, method.name))
        if used:
            line = next(m.lineno for m in above.body if isinstance(m, FunctionNode) and m.name == method.name)
            way = "await " if isinstance(method, ast.AsyncFunctionDef) else ""
            yield (
                method.lineno,
                f"{method.name} replaces that of {parent.__name__} ({short_place(file, line)}), which sets "
                f"self.{used[0]}; write {way}super().{method.name}() in its first line",
            )


def _methods(definition: ast.ClassDef) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    return (method for method in definition.body if isinstance(method, FunctionNode))


def _attributes(code: ast.AST, context: type[ast.expr_context]) -> set[str]:
    return {
        node.attr
        for node in ast.walk(code)
        if isinstance(node, ast.Attribute) and is_own(node) and isinstance(node.ctx, context)
    }


def _set_by(definition: ast.ClassDef, name: str) -> set[str]:
    return {a for method in _methods(definition) if method.name == name for a in _attributes(method, ast.Store)}


def _set_elsewhere(definition: ast.ClassDef) -> set[str]:
    others = {a for method in _methods(definition) if method.name == "__init__" for a in _attributes(method, ast.Store)}
    body = {
        t.id
        for node in definition.body
        if isinstance(node, ast.Assign)
        for t in node.targets
        if isinstance(t, ast.Name)
    }
    annotated = {
        n.target.id
        for n in definition.body
        if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name) and n.value
    }
    return others | body | annotated


def _read_by(definition: ast.ClassDef, name: str) -> set[str]:
    return {a for method in _methods(definition) if method.name != name for a in _attributes(method, ast.Load)}
