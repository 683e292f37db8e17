"""Values that the names and the attributes of `self` in a file are bound to, as far as its source shows them."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache
from typing import NamedTuple, TypeAlias

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, walk

Scope: TypeAlias = FunctionNode | ast.ClassDef | ast.Module


class Value(NamedTuple):
    """One binding of a name."""

    expression: ast.expr | None
    """None if it is bound in another way than by an assignment, as an argument is."""
    around: tuple[ast.AST, ...]
    """The nodes that enclose the binding, by which the names in it are resolved."""


class Bindings:
    """All bindings of a module, by the scope of the name; an attribute of `self` belongs to the class.

    Args:
        module: The syntax tree of a file.
    """

    def __init__(self, module: ast.Module) -> None:
        self._found: dict[tuple[Scope, str], list[Value]] = {}
        self._set_elsewhere: set[str] = set()
        """Attributes that are set on anything other than `self`."""
        for node, parents in walk(module):
            for target, value in _bound(node):
                self._bind(target, value, tuple(parents))

    def of(self, named: ast.expr, parents: Sequence[ast.AST]) -> list[Value]:
        """Return all values that a name, or an attribute of `self`, is bound to; empty if they are not known.

        Args:
            parents: The nodes that enclose the name.
        """
        if is_own(named):
            owner = _class(parents)
            found = self._found.get((owner, named.attr), []) if owner is not None else []
            return [] if named.attr in self._set_elsewhere else found
        if isinstance(named, ast.Name):
            scopes = [scope for scope in parents if isinstance(scope, (FunctionNode, ast.Module))]
            for scope in reversed(scopes):
                if found := self._found.get((scope, named.id), []):
                    return found
        return []

    def _bind(self, target: ast.AST | str, value: ast.expr | None, around: tuple[ast.AST, ...]) -> None:
        scope = next((s for s in reversed(around) if isinstance(s, (*_SCOPES,))), None)
        if isinstance(target, ast.Attribute):
            scope = _class(around) if is_own(target) else None
            if scope is None:
                self._set_elsewhere.add(target.attr)
        name = (
            target.attr if isinstance(target, ast.Attribute) else target.id if isinstance(target, ast.Name) else target
        )
        if scope is not None and isinstance(name, str):
            self._found.setdefault((scope, name), []).append(Value(value, around))


_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Module)


@cache
def bindings_of(module: ast.Module) -> Bindings:
    """Return the bindings of a module, collected once."""
    return Bindings(module)


def _class(parents: Sequence[ast.AST]) -> ast.ClassDef | None:
    return next((node for node in reversed(parents) if isinstance(node, ast.ClassDef)), None)


def _bound(node: ast.AST) -> Iterator[tuple[ast.AST | str, ast.expr | None]]:
    """Yield what a node binds, each with its value."""
    match node:
        case ast.Assign(targets=targets, value=value):
            for target in targets:
                plain = isinstance(target, (ast.Name, ast.Attribute))
                yield from [(part, value if plain else None) for part in _parts(target)]
        case ast.AnnAssign(target=target, value=ast.expr() as value) | ast.NamedExpr(target=target, value=value):
            yield target, value
        case ast.AugAssign(target=target) | ast.For(target=target) | ast.AsyncFor(target=target):
            yield from [(part, None) for part in _parts(target)]
        case ast.comprehension(target=target) | ast.withitem(optional_vars=ast.expr() as target):
            yield from [(part, None) for part in _parts(target)]
        case ast.arg(arg=str(name)) | ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)):
            yield name, None
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name, None
        case ast.alias(name=name, asname=asname):
            yield (asname or name).partition(".")[0], None
        case ast.Global(names=names) | ast.Nonlocal(names=names):
            yield from [(name, None) for name in names]


def _parts(target: ast.expr) -> Iterator[ast.expr]:
    """Yield the names and attributes that a target consists of."""
    match target:
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            for part in parts:
                yield from _parts(part)
        case ast.Starred(value=part):
            yield from _parts(part)
        case ast.Name() | ast.Attribute():
            yield target
