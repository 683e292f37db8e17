"""Attributes that keep a parameter's first value: `self.speed = self.declare_parameter("speed", 1.0)`.

A node may want it so. Hence nothing is said before somebody sets the parameter, without effect on the node.
"""

from __future__ import annotations

import ast
from functools import cache
from typing import NamedTuple

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, nodes_in, syntax_of
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import Place
from graphflow.runtime.mistakes.source.shadowing import definition_of

_FIRST = ("__init__", "on_start")
"""Methods that run once, before any handler."""
_FOLLOWING = {"observe", "check", "setattr", "__dict__", "vars"}
"""Names in modules that may follow parameters, or set attributes, in another way."""


class _Copy(NamedTuple):
    attribute: str
    place: Place


def kept(node: object, name: str, old: object, new: object) -> str:
    """Return a complaint about an attribute that still has the old value of a parameter; "" if there is none.

    Args:
        name: The parameter, which is now set from `old` to `new`.
    """
    cls: type = type(node)
    copy = _copy(cls, name)
    if copy is None or new is None or old == new or vars(node).get(copy.attribute) != old:
        return ""
    return (
        f"{copy.place}: self.{copy.attribute} keeps the value that {name!r} had at the start, and the node goes on "
        f'with {old!r}; read self.parameters.get("{name}") where it is used, or declare {name} = Param(...) in the '
        "class"
    )


@cache
def _copy(cls: type, name: str) -> _Copy | None:
    """Find the only attribute of a class that copies a parameter, if no code of its module follows the parameter."""
    found: list[_Copy] = []
    times = 0
    for parent in cls.__mro__:
        source = definition_of(parent) if is_users_module(parent.__module__) else None
        if source is None:
            continue
        definition, file = source
        for node in syntax_of(file).nodes:
            match node:
                case ast.Attribute(attr=word) | ast.Name(id=word) if word in _FOLLOWING:
                    return None
                case ast.Constant(value=str(text)) if text == name:
                    times += 1
        found += [_Copy(attribute, Place(file, line)) for attribute, line in _copies(definition, name)]
    return found[0] if len(found) == times == 1 else None


def _copies(definition: ast.ClassDef, name: str) -> list[tuple[str, int]]:
    """Return the attributes, with lines, that are set once, from the declaration of a parameter, and used later."""
    found: list[tuple[str, int]] = []
    methods = [item for item in definition.body if isinstance(item, FunctionNode)]
    stores = [n.attr for n in nodes_in(definition) if isinstance(n, ast.Attribute) and isinstance(n.ctx, ast.Store)]
    used = {
        node.attr
        for method in methods
        for node in (nodes_in(method) if method.name not in _FIRST else ())
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load) and is_own(node)
    }
    for statement in (node for method in methods if method.name in _FIRST for node in nodes_in(method)):
        match statement:
            case ast.Assign(
                targets=[ast.Attribute(value=ast.Name(id="self"), attr=attribute)],
                value=ast.Call(
                    func=ast.Attribute(value=ast.Name(id="self"), attr="declare_parameter"),
                    args=[ast.Constant(value=text), *_],
                ),
            ) if text == name and stores.count(attribute) == 1 and attribute in used:
                found.append((attribute, statement.lineno))
    return found
