"""Attributes under two names: callbacks set `self.pos`, which nothing reads, and others read `self.pose`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, nodes_in
from graphflow.analysis.words import methods_in
from graphflow.names import nearest


def two_names(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines that set such an attribute; each comes with the other name.

    The other one is set in the constructor only, to a constant, so that what is read never changes.
    """
    read = methods_in(module)
    for cls in nodes_in(module):
        if not isinstance(cls, ast.ClassDef) or not cls.bases:
            continue
        first: dict[str, int] = {}
        later: dict[str, int] = {}
        for method in cls.body:
            if isinstance(method, FunctionNode):
                _note_stores(method, first if method.name == "__init__" else later)
        fixed = {name for name in first if first[name] and name not in later and name in read}
        for name, line in later.items():
            other = nearest(name, fixed, cutoff=0.8) if name not in read and name not in first else None
            if other is not None:
                text = f"nothing reads self.{name}, and self.{other} stays what line {first[other]} sets"
                yield line, f"{text}: write self.{other}"


def _note_stores(method: FunctionNode, found: dict[str, int]) -> None:
    """Note the attributes that a method sets, with the first line, or 0 if a constructor sets more than constants."""
    constant = {
        target: isinstance(node.value, ast.Constant)
        for node in nodes_in(method)
        if isinstance(node, ast.Assign)
        for target in node.targets
    }
    for node in nodes_in(method):
        if is_own(node) and not isinstance(node.ctx, ast.Load):
            is_constant = method.name != "__init__" or constant.get(node, False)
            found[node.attr] = found.get(node.attr, node.lineno) if is_constant else 0
