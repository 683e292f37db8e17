"""Parameters of a class that only `__init__` or `on_start` reads, so that setting one has no effect.

A node may want it so. Hence nothing is said before somebody sets the parameter.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from functools import cache

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import NESTED, FunctionNode, nodes_in, syntax_of, walk
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import Place
from graphflow.runtime.callables import file_of
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import Param
from graphflow.runtime.mistakes.source.project_words import other_modules
from graphflow.runtime.mistakes.source.shadowing import definition_of

_FIRST = ("__init__", "on_start")
"""Methods that run once, before any handler."""
_OTHER_WAYS = {"observe", "parameters", "getattr", "setattr", "vars", "__dict__", "attrgetter", "eval", "exec"}
"""Names in modules that may read parameters, or follow them, in another way."""


def without_effect(cls: type, name: str) -> str:
    """Return a sentence about a parameter that is read only before it can be set; "" if it may be read later.

    Args:
        name: The parameter, which is now set.
    """
    found = _reads(cls, name)
    if found is None:
        return ""
    attribute, method, place = found
    return (
        f"{place}: {name!r} is set without effect, since only {method} reads it; read self.{attribute} where it is "
        f"used, or declare it with read_only=True"
    )


@cache
def _reads(cls: type, name: str) -> tuple[str, str, Place] | None:
    """Return the attribute of a parameter, and the only method that reads it, with the line."""
    declarations = declared.declarations(cls)
    attribute = next((a for a, v in declarations.items() if isinstance(v, Param) and v.parameter.name == name), None)
    if attribute is None:
        return None
    files: dict[str, set[ast.AST]] = {}
    """By file: the nodes of the tree that are the known reads."""
    first: tuple[str, Place] | None = None
    for parent in cls.__mro__:
        if not is_users_module(parent.__module__):
            continue
        source = definition_of(parent)
        if source is None:
            return None
        definition, file = source
        if attribute in _body_names(definition):
            return None  # it sets the rate of a timer, or has an `on_change`
        reads = [*_first_reads(definition, attribute)]
        files.setdefault(file, set()).update(node for node, _ in reads)
        if reads and first is None:
            first = reads[0][1], Place(file, reads[0][0].lineno)
    if first is None or any(_is_used(file, attribute, name, known) for file, known in files.items()):
        return None
    own = {syntax_of(file).module for file in files}
    around = file_of(sys.modules.get(cls.__module__)) or ""
    others = [module for word in {attribute, name} for module in other_modules(around, word)]
    if any(_mentions(module, attribute, name) for module in others if module not in own):
        return None
    return attribute, *first


def _first_reads(definition: ast.ClassDef, attribute: str) -> Iterator[tuple[ast.Attribute, str]]:
    """Yield the reads of an attribute in the methods that run once, outside functions within them."""
    for method in definition.body:
        if isinstance(method, FunctionNode) and method.name in _FIRST:
            for node, parents in walk(method):
                is_read = isinstance(node, ast.Attribute) and node.attr == attribute and isinstance(node.ctx, ast.Load)
                # A loop of `on_start` may go on for as long as the node runs; a function may be called at any time.
                if (
                    is_read
                    and is_own(node)
                    and not any(isinstance(p, (*NESTED, ast.While, ast.AsyncFor)) for p in parents[1:])
                ):
                    yield node, method.name


def _body_names(definition: ast.ClassDef) -> set[str]:
    """Return the names that a class body reads, in declarations and decorators."""
    parts: list[ast.AST] = []
    for item in definition.body:
        parts += [*item.decorator_list, item.args] if isinstance(item, FunctionNode) else [item]
    return {n.id for part in parts for n in nodes_in(part) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}


def _is_used(file: str, attribute: str, name: str, known: set[ast.AST]) -> bool:
    """Whether a file may use a parameter in another way than by the known reads."""
    for node in syntax_of(file).nodes:
        match node:
            case ast.Attribute(attr=word) | ast.Name(id=word) if word in _OTHER_WAYS:
                return True
            case ast.Attribute(attr=word) if word == attribute and node not in known:
                return True
            case ast.Constant(value=str(text)) if text in (attribute, name):
                return True
    return False


def _mentions(module: ast.Module, attribute: str, name: str) -> bool:
    return any(
        (isinstance(node, ast.Attribute) and node.attr == attribute)
        or (isinstance(node, ast.Constant) and node.value in (attribute, name))
        for node in nodes_in(module)
    )
