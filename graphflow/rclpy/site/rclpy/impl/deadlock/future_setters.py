"""Whether the program's own code may complete an answer's future: cancel it, or set its result, as watchdogs do."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from typing import NamedTuple

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, Syntax, nodes_in, syntax_of
from graphflow.analysis.user_code import is_installed, is_users
from rclpy.task import Future

_WAYS = ("cancel", "set_result", "set_exception", "remove_pending_request")
_OTHERS = ("create_timer", "create_rate", "Timer", "Future")
"""Suffixes of constructors whose objects can be cancelled or set but are not an answer's future."""


class _Ending(NamedTuple):
    """A place in the source that may complete a future."""

    attribute: str = ""
    """The attribute of `self` that it completes; empty for anything else."""
    cls: str = ""
    """The enclosing class; empty for none."""


def programs_files() -> list[str]:
    """Return the files of the program's own modules, those that are not installed."""
    files = [str(file) for module in list(sys.modules.values()) if (file := getattr(module, "__file__", None))]
    return [file for file in files if is_users(file) and file.endswith(".py") and not is_installed(file)]


def may_be_ended(future: Future, nodes: Iterable[object], files: Iterable[str]) -> bool:
    """Whether some code may complete an awaited future, according to its source.

    Args:
        nodes: The nodes, whose attributes are known.
        files: The files to search.
    """
    nodes = list(nodes)
    classes = _classes_of_nodes(nodes)
    return any(_may_end(ending, future, nodes, classes) for file in files for ending in _endings(file))


def _classes_of_nodes(nodes: list[object]) -> set[str]:
    """Return the names of all existing node classes."""
    todo = [cls for node in nodes[:1] for cls in type(node).__mro__ if cls.__module__ == "rclpy.node"]
    names = set[str]()
    while todo:
        cls = todo.pop()
        names.add(cls.__name__)
        todo += cls.__subclasses__()
    return names


def _may_end(ending: _Ending, future: Future, nodes: list[object], classes: set[str]) -> bool:
    of_class = [node for node in nodes if any(cls.__name__ == ending.cls for cls in type(node).__mro__)]
    if ending.cls in classes and not of_class:
        return False  # there is no such node
    known = [vars(node)[ending.attribute] for node in of_class if ending.attribute in vars(node)]
    return not known or any(value is future for value in known)


@cache
def _endings(file: str) -> list[_Ending]:
    try:
        syntax = syntax_of(file)
    except (OSError, SyntaxError, ValueError):  # its source is not available
        return [_Ending()]
    return list(_endings_in(syntax))


def _endings_in(syntax: Syntax) -> Iterator[_Ending]:
    for node, parents in syntax.parts:
        if isinstance(node, ast.Attribute) and node.attr in _WAYS:
            owner = node.value
            within = next((parent for parent in parents if isinstance(parent, ast.ClassDef)), None)
            cls = within.name if within is not None else ""
            if isinstance(owner, ast.Attribute) and is_own(owner):
                if not _is_other_object(owner, [syntax.module]):
                    yield _Ending(owner.attr, cls)
            else:
                functions = [parent for parent in parents if isinstance(parent, FunctionNode)]
                if not (isinstance(owner, ast.Name) and _is_other_object(owner, functions or [syntax.module])):
                    yield _Ending("", cls)


def _is_other_object(owner: ast.Name | ast.Attribute, scopes: Iterable[ast.AST]) -> bool:
    """Whether a name or attribute is not an answer's future, judged by its constructor or else by its name."""
    word = ast.unparse(owner)
    made = (n for scope in scopes for n in nodes_in(scope) if isinstance(n, ast.Assign | ast.AnnAssign) and n.value)
    values = [
        n.value
        for n in made
        if word in map(ast.unparse, n.targets if isinstance(n, ast.Assign) else [n.target])
        and not (isinstance(n.value, ast.Constant) and n.value.value is None)
    ]
    if not values:
        return isinstance(owner, ast.Name) and owner.id.lower().endswith("timer")
    return all(isinstance(v, ast.Call) and ast.unparse(v.func).endswith(_OTHERS) for v in values)
