"""The words of a file's source: whether anything in it refers to a definition."""

from __future__ import annotations

import ast
from functools import cache

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_SHOWING = ("print", "debug", "info", "warning", "warn", "error", "exception", "critical", "fatal", "log")
"""Functions whose texts name nothing: a handler often logs its own name."""


@cache
def words_in(module: ast.Module) -> set[str]:
    """Return the attributes and names that a module reads, and its strings, but for texts that are only shown."""
    return _attributes_in(module) | _names_in(module)


@cache
def methods_in(module: ast.Module) -> set[str]:
    """Return the words by which a module may refer to methods: attributes, strings, and names in bodies of classes."""
    found = set(_attributes_in(module))
    for cls in (node for node in nodes_in(module) if isinstance(node, ast.ClassDef)):
        for statement in cls.body:
            for part in statement.decorator_list if isinstance(statement, FunctionNode) else [statement]:
                found |= _names_in(part)
    return found


def _names_in(tree: ast.AST) -> set[str]:
    return {node.id for node in nodes_in(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}


@cache
def _attributes_in(module: ast.Module) -> set[str]:
    found: set[str] = set()
    shown: set[ast.expr] = set()
    others = {"graph"} | {
        a.asname or a.name.partition(".")[0] for n in nodes_in(module) if isinstance(n, ast.Import) for a in n.names
    }
    for node in nodes_in(module):
        match node:
            case ast.Attribute(value=ast.Name(id=owner)) if owner in others:
                continue  # `graphflow.run(Talker)` calls no method of a node's, nor does a test's `graph.start(...)`
            case ast.Call(func=function, args=arguments) if last_name(function) in _SHOWING:
                shown.update(arguments)
            case ast.Constant() if node in shown:
                continue
            case ast.Attribute(attr=word, ctx=ast.Load()) | ast.Constant(value=str(word)):
                found.add(word)
    return found


@cache
def prefixes_in(module: ast.Module) -> tuple[str, ...]:
    """Return the beginnings of the names that a module puts together for `getattr`, as in `f"on_{state}"`."""
    found: list[str] = []
    for node in nodes_in(module):
        match node:
            case ast.Call(func=ast.Name(id="getattr"), args=[_, ast.JoinedStr(values=[first, *_]), *_]):
                found.append(first.value if isinstance(first, ast.Constant) and isinstance(first.value, str) else "")
            case ast.Call(func=ast.Name(id="getattr"), args=[_, ast.BinOp(left=ast.Constant(value=str(first))), *_]):
                found.append(first)
    return tuple(found)
