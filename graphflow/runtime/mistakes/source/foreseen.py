"""Mistakes in a node class's source that a running node reports by itself, as they occur: for `graphflow check`.

`slips` has those that nothing else would report.
"""

from __future__ import annotations

import ast
import logging
import sys
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.mistakes.calls.called_early import results_passed
from graphflow.analysis.syntax import FunctionNode
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import DeclarationError, Place
from graphflow.runtime.declarations.declare import Declaration
from graphflow.runtime.declarations.misplaced import not_of_node
from graphflow.runtime.mistakes.source.early_waits import early_waits
from graphflow.runtime.mistakes.source.never_awaited import never_awaited
from graphflow.runtime.mistakes.source.shadowing import definition_of
from graphflow.runtime.mistakes.source.wrong_fields import resolved

logger = logging.getLogger("graphflow")


def foreseen(cls: type) -> list[str]:
    """Return a sentence with its place for each such mistake of a class and of its bases in user code."""
    try:
        return list(_foreseen(cls))
    except Exception as error:  # a bug in these checks must not keep a graph from being checked
        logger.debug("the source of %s was not checked", cls.__name__, exc_info=error)
        return []


def _foreseen(cls: type) -> Iterator[str]:
    for parent in cls.__mro__:
        source = definition_of(parent) if is_users_module(parent.__module__) else None
        if source is None:
            continue
        definition, file = source
        space = vars(sys.modules[parent.__module__])
        found = [*never_awaited(cls, parent, definition, space), *early_waits(cls, definition)]
        found += results_passed(definition, is_of_threads=False)
        yield from (f"{Place(file, line)}: {text}" for line, text in sorted(found))


def check_init(cls: type) -> None:
    """Check that the `__init__` of a class assigns no declarations, with which no node can be made.

    Raises:
        DeclarationError: It does.
    """
    owner = next((parent for parent in cls.__mro__ if "__init__" in vars(parent)), cls)
    source = definition_of(owner) if is_users_module(owner.__module__) else None
    if source is not None:
        definition, file = source
        for line, text in _made_too_late(definition, vars(sys.modules[owner.__module__])):
            raise DeclarationError(f"{Place(file, line)}: {text}")


def _made_too_late(definition: ast.ClassDef, space: dict[str, object]) -> Iterator[tuple[int, str]]:
    for method in definition.body:
        if not isinstance(method, FunctionNode) or method.name != "__init__":
            continue
        for statement in method.body:
            match statement:
                case ast.Assign(targets=[ast.Attribute() as target], value=ast.Call(func=function)) if is_own(target):
                    kind = resolved(function, space)
                    if isinstance(kind, type) and issubclass(kind, Declaration):
                        yield statement.lineno, not_of_node(target.attr, kind)
