"""Publishers to which a node publishes only at its start, each line at most once.

Such lines are in `on_start` or in a `@task`, outside loops. Any other use of the publisher makes this unknown.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import REPEATING, FunctionNode, syntax_of
from graphflow.analysis.user_code import is_users_module, short_place
from graphflow.analysis.words import words_in
from graphflow.errors import Place
from graphflow.runtime.declarations import declared
from graphflow.runtime.mistakes.source.project_words import other_modules
from graphflow.runtime.mistakes.source.shadowing import definition_of

_BY_NAME = {"getattr", "vars", "__dict__", "exec", "eval", "attrgetter", "methodcaller"}
"""Names in modules that may use an attribute in another way."""


def single_sends(node: object, publisher: object) -> list[Place]:
    """Return the lines at which a node publishes with one of its publishers; empty if one may run twice, or unknown."""
    cls = type(node)
    names = {name for name, value in vars(node).items() if value is publisher}
    names |= {name for name in declared.declarations(cls) if getattr(node, name, None) is publisher}
    if len(names) != 1:
        return []
    try:
        return _sends(cls, names.pop())
    except (OSError, SyntaxError, ValueError):  # no readable source
        return []


def _sends(cls: type, name: str) -> list[Place]:
    found: list[Place] = []
    sources = [definition_of(parent) for parent in cls.__mro__ if is_users_module(parent.__module__)]
    files = dict.fromkeys(source[1] for source in sources if source is not None)
    bodies = [source[0] for source in sources if source is not None]
    tasks = {task for task, handler in declared.handlers(cls).items() if handler.kind == "task"}
    for file in files:
        words = words_in(syntax_of(file).module)
        if not words.isdisjoint({*_BY_NAME, *tasks}):
            return []
        for other in other_modules(file, name):
            if name in words_in(other):
                return []
        for use, parents in syntax_of(file).parts:
            if not isinstance(use, ast.Attribute) or use.attr != name or isinstance(use.ctx, ast.Store):
                continue
            if not is_own(use) or not _is_single(parents, bodies, {"on_start", *tasks}):
                return []
            found.append(short_place(file, use.lineno))
    return found


def _is_single(parents: Sequence[ast.AST], bodies: Sequence[ast.ClassDef], methods: set[str]) -> bool:
    """Whether a use of an attribute publishes with it, in one of some methods of a class, outside any loop."""
    match parents:
        case [ast.Module(), ast.ClassDef() as body, method, *inner, ast.Call(func=call), ast.Attribute() as above]:
            is_published = call is above and above.attr == "publish"
            is_method = isinstance(method, FunctionNode) and method.name in methods and body in bodies
            return is_published and is_method and not any(isinstance(node, REPEATING) for node in inner)
    return False
