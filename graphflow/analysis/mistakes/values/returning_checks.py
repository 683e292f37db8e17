"""Checks of parameters that return their verdict: a check refuses a value by raising ValueError."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, is_nested, walk


def returning_checks(definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the lines of `@speed.check` methods that return a value; each comes with the form that refuses one."""
    for method in definition.body:
        if not isinstance(method, FunctionNode) or not any(map(_is_check, method.decorator_list)):
            continue
        for node, parents in walk(method):
            match node:
                case ast.Return(value=ast.expr() as value) if not is_nested(parents) and not _is_nothing(value):
                    text = f"{method.name} is a check, which refuses a value by raising"
                    way = "" if isinstance(value, ast.Constant) else f"if not ({ast.unparse(value)}): "
                    yield node.lineno, f'{text}: {way}raise ValueError("why"), in place of return'


def _is_check(decorator: ast.expr) -> bool:
    return isinstance(decorator, ast.Attribute) and decorator.attr == "check" and isinstance(decorator.value, ast.Name)


def _is_nothing(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and (value.value is None or value.value is True)
