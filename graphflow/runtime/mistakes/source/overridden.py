"""Handlers that accidentally override a parent's handler of the same name and another purpose.

Python keeps the last method of a name: a subclass's `pose_callback` for the topic `goal` removes the parent's for
`pose`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, nodes_in
from graphflow.analysis.user_code import short_place
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import Subscription
from graphflow.runtime.declarations.handlers import MARK, Handler
from graphflow.runtime.mistakes.source.shadowing import definition_of

_LOST = {"subscription": "which is no longer received", "service": "which is no longer answered"}
_LOST |= {"action": "which is no longer answered"}


def overridden(cls: type, definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the lines of a class that remove a parent's handler; each comes with a sentence.

    An override counts as intended if the class calls the parent's handler, if another handler has the lost one's topic,
    or if it sets all the attributes that the parent's sets, and so does the same from another topic.

    Args:
        definition: The class statement.
    """
    for method in definition.body:
        if not isinstance(method, FunctionNode):
            continue
        own = _handler(cls, method.name)
        owner = next((parent for parent in cls.__mro__[1:] if method.name in vars(parent)), None)
        lost = next((h for parent in cls.__mro__[1:] if (h := _handler(parent, method.name)) is not None), None)
        if own is None or owner is None or lost is None or _use(own) == _use(lost) or _is_heard(cls, lost):
            continue
        parents = {parent.__name__ for parent in cls.__mro__[1:]}
        if _calls_parent(definition, method.name, parents) or _does_the_same(method, owner):
            continue
        place = short_place(lost.place.file, lost.place.line)
        is_typed = (own.kind, own.name) == (lost.kind, lost.name)
        names = f"{method.name} {_shown(own, is_typed)} replaces {method.name} {_shown(lost, is_typed)}"
        why = _LOST.get(lost.kind, "which no longer runs")
        yield method.lineno, f"{names} ({place}), {why}; if both are meant, give it another name"


def _handler(cls: type, name: str) -> Handler | None:
    """Return the declaration of a method in the class itself."""
    mark = getattr(vars(cls).get(name), MARK, None)
    return mark if isinstance(mark, Handler) else None


def _use(handler: Handler) -> tuple[str, str, object]:
    """Return the purpose of a handler; timers may differ in their periods."""
    return handler.kind, handler.name, handler.type


def _shown(handler: Handler, is_typed: bool) -> str:
    if not handler.name:
        return f"(a {handler.kind})"
    return f"on {handler.name!r}" + (f" of {handler.type.__qualname__}" if is_typed else "")


def _is_heard(cls: type, lost: Handler) -> bool:
    """Whether a class has another handler with the purpose of a lost one."""
    if any(_use(handler) == _use(lost) for handler in declared.handlers(cls).values()):
        return lost.kind in _LOST
    streams = [item for item in declared.declarations(cls).values() if isinstance(item, Subscription)]
    return lost.kind == "subscription" and any((s.name, s.type) == (lost.name, lost.type) for s in streams)


def _calls_parent(definition: ast.ClassDef, name: str, parents: set[str]) -> bool:
    """Whether a class refers to its parent's method, as in `super().heard` or `Base.heard`."""
    for node in nodes_in(definition):
        match node:
            case ast.Attribute(value=ast.Call(func=ast.Name("super")), attr=attr) if attr == name:
                return True
            case ast.Attribute(value=owner, attr=attr) if attr == name:
                if ast.unparse(owner).rpartition(".")[2] in parents:
                    return True
    return False


def _does_the_same(method: FunctionNode, owner: type) -> bool:
    """Whether a method sets every attribute that the parent's sets, of which there is at least one."""
    source = definition_of(owner)
    for before in source[0].body if source is not None else ():
        if isinstance(before, FunctionNode) and before.name == method.name and (lost := _sets(before)):
            return lost <= _sets(method)
    return False


def _sets(method: FunctionNode) -> set[str]:
    """Return the node's attributes that a method sets."""
    found = (n for n in nodes_in(method) if isinstance(n, ast.Attribute) and isinstance(n.ctx, ast.Store))
    return {node.attr for node in found if is_own(node)}
