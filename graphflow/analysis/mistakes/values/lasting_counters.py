"""Counters that nothing counts: `self.count = 0` that other methods read, and no line changes."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_COUNTER = re.compile(r"_?(i|n|(\w+_)?(count|counter|ticks?|iterations?|index))")
_BY_NAME = ("setattr", "vars", "__dict__")
"""Names in a file that may change an attribute whose name is not written there."""


def lasting_counters(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines that read such a counter, the first of each; it comes with its correction.

    A counter is an attribute with a counter's name that starts at 0 in the class or its `__init__`.
    """
    if any(last_name(node) in _BY_NAME for node in nodes_in(module) if isinstance(node, (ast.Name, ast.Attribute))):
        return
    stores = [node.attr for node in nodes_in(module) if isinstance(node, ast.Attribute) and _is_set(node)]
    for cls in nodes_in(module):
        if isinstance(cls, ast.ClassDef) and cls.bases:
            first = _first_reads(cls)
            for name, starts in _started(cls).items():
                if name in first and stores.count(name) == starts:
                    yield first[name], f"self.{name} stays 0, since no line changes it: write self.{name} += 1"


def _first_reads(cls: ast.ClassDef) -> dict[str, int]:
    """Return the attributes that methods use, each with the first line that does; `__init__` is left out."""
    found: dict[str, int] = {}
    for method in cls.body:
        if isinstance(method, FunctionNode) and method.name != "__init__":
            for node in nodes_in(method):
                if is_own(node):
                    found[node.attr] = min(node.lineno, found.get(node.attr, node.lineno))
    return found


def _is_set(node: ast.Attribute) -> bool:
    return not isinstance(node.ctx, ast.Load)


def _started(cls: ast.ClassDef) -> dict[str, int]:
    """Return the counters of a class, each with the number of times that `__init__` sets it to 0."""
    found: dict[str, int] = {}
    for statement in cls.body:
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=0)) if _COUNTER.fullmatch(name):
                found.setdefault(name, 0)
            case ast.FunctionDef(name="__init__", body=body):
                for line in body:
                    match line:
                        case ast.Assign(targets=[ast.Attribute() as target], value=ast.Constant(value=0)):
                            if is_own(target) and _COUNTER.fullmatch(target.attr):
                                found[target.attr] = found.get(target.attr, 0) + 1
    return found
