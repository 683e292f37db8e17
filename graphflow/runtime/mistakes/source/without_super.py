"""Hooks of a class that replace those of a parent, whose handlers then miss their attributes."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, nodes_in
from graphflow.analysis.user_code import short_place
from graphflow.runtime.mistakes.source.shadowing import definition_of

_HOOKS = ("on_start", "on_configure", "on_activate")


def without_super(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find hooks of a class that replace those of a parent, whose attributes the parent's handlers then miss."""
    for method in definition.body:
        if not isinstance(method, FunctionNode) or method.name not in _HOOKS:
            continue
        if any(isinstance(node, ast.Attribute) and node.attr == method.name for node in nodes_in(method)):
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
        for node in nodes_in(code)
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
