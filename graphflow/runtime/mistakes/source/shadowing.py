"""Names that a class body binds twice, so that one handler or declaration is silently lost.

Examples are an attribute and a handler of one name, two handlers called `callback`, or `self.enable = True` over a
service `enable`. Python keeps the last, and the node would start without the other.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Collection, Iterator
from functools import cache

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, syntax_of, walk
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import DeclarationError, Place
from graphflow.runtime.callables import file_of
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import Param

_DECLARING = {"subscription", "service", "timer", "action", "task"}
_DECLARING |= {"Publisher", "Subscription", "Client", "ActionClient", "Param", "Group"}
_OF_NODES = {
    "name": 'choose another attribute; the node\'s own name is given by super().__init__("bob") or node_name = "bob"',
    **dict.fromkeys(
        ("namespace", "full_name", "context", "clock", "group", "endpoints", "is_running", "derivations", "log"),
        "choose another name",
    ),
}
"""Attributes of every node that code must not set, with the alternative for each."""
_PARTS = {"setter", "getter", "deleter", "overload"}
"""Decorators of functions that share a name on purpose."""


@cache
def check_bound_once(cls: type) -> None:
    """Check that a class and its parents bind no name of a handler or declaration twice.

    Raises:
        DeclarationError: One is; the text has both lines.
    """
    names = {
        **declared.handlers(cls),
        **{k: v for k, v in declared.declarations(cls).items() if not isinstance(v, Param)},
    }
    for parent in cls.__mro__:
        found = definition_of(parent) if is_users_module(parent.__module__) else None
        if found is not None:
            definition, file = found
            _check_body(definition, file)
            _check_assignments(definition, file, names.keys())


def definition_of(cls: type) -> tuple[ast.ClassDef, str] | None:
    """Return a class statement and its file; None if it is missing or ambiguous."""
    file = file_of(sys.modules.get(cls.__module__)) or ""
    try:
        definitions = [item for item in syntax_of(file).classes if item.name == cls.__name__]
    except (OSError, SyntaxError, ValueError):
        return None
    if len(definitions) > 1:
        definitions = [item for item in definitions if item.lineno == vars(cls).get("__firstlineno__")]
    return (definitions[0], file) if len(definitions) == 1 else None


def _check_body(definition: ast.ClassDef, file: str) -> None:
    first: dict[str, tuple[int, bool]] = {}
    for name, line, is_declared in _bound(definition):
        before, was_declared = first.setdefault(name, (line, is_declared))
        if before != line and (is_declared or was_declared):
            raise DeclarationError(
                f"{Place(file, line)}: {definition.name} has another {name!r} in line {before}, which is lost; "
                "rename one of the two"
            )


def _bound(definition: ast.ClassDef) -> Iterator[tuple[str, int, bool]]:
    """List the names that a class body binds, each with its line and whether it declares something."""
    for item in definition.body:
        match item:
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                words = [_last_word(decorator) for decorator in item.decorator_list]
                if not _PARTS.intersection(words):
                    yield item.name, item.lineno, not _DECLARING.isdisjoint(words)
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                yield name, item.lineno, _last_word(value) in _DECLARING
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                yield name, item.lineno, _last_word(value) in _DECLARING


def _last_word(expression: ast.expr) -> str:
    """Return the last part of a dotted name: `timer` of `@graphflow.timer(1.0)`."""
    function = expression.func if isinstance(expression, ast.Call) else expression
    return ast.unparse(function).rpartition(".")[2]


def _check_assignments(definition: ast.ClassDef, file: str, names: Collection[str]) -> None:
    for method in definition.body:
        if not isinstance(method, FunctionNode):
            continue
        for node, parents in walk(method):
            if any(isinstance(parent, ast.ClassDef) for parent in parents):
                continue  # its `self` is another object
            if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and is_own(node):
                name, place = node.attr, Place(file, node.lineno)
                if name in _OF_NODES:
                    raise DeclarationError(
                        f"{place}: every node has self.{name}, which cannot be set; {_OF_NODES[name]}"
                    )
                if name in names:
                    raise DeclarationError(
                        f"{place}: self.{name} hides the declaration {definition.name}.{name}; rename the attribute"
                    )
