"""Local names of messages in a function: changes of their fields are no changes of the node."""

from __future__ import annotations

import ast
from collections.abc import Mapping

from graphflow.analysis.syntax import nodes_in
from graphflow.msgs.base import Message

CONTAINER_MAKERS = {"list", "dict", "set", "deque", "defaultdict", "sorted", "Counter"}
CONTAINER_MAKERS |= {"array", "zeros", "ones", "full", "copy", "deepcopy"}
"""Functions whose results no other code knows."""


_classes: list[type] = [Message]


def know_messages(cls: type) -> None:
    """Treat the instances of a class and its subclasses as messages."""
    _classes.append(cls)


def messages() -> tuple[type, ...]:
    """Return the classes of messages."""
    return tuple(_classes)


def messages_of(function: ast.FunctionDef | ast.AsyncFunctionDef, globals_: Mapping[str, object]) -> set[str]:
    """Return the local names of messages: each binding creates a message, or is annotated with a message class."""
    bound: dict[str, list[ast.expr | None]] = {}
    for node in nodes_in(function):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=made)):
                bound.setdefault(name, []).append(made)
            case ast.arg(arg=name, annotation=annotation):
                bound.setdefault(name, []).append(annotation)
            case ast.Name(id=name, ctx=ast.Store()):
                bound.setdefault(name, []).append(None)
    # The target of an assignment is counted twice: with the class at the assignment, and with None as a name.
    made_here = {name: [v for v in values if v is not None] for name, values in bound.items()}
    stored = {name: sum(v is None for v in values) for name, values in bound.items()}
    arguments = {a.arg for a in nodes_in(function.args) if isinstance(a, ast.arg)}
    return {
        name
        for name, values in made_here.items()
        if values and all(_is_message(value, globals_) for value in values)
        if stored[name] == len(values) - (name in arguments)
    }


def _is_message(expression: ast.expr, globals_: Mapping[str, object]) -> bool:
    """Whether an expression is a message class."""
    first, *rest = ast.unparse(expression).strip("'\"").split(".")
    value = globals_.get(first)
    for part in rest:
        value = getattr(value, part, None)
    return isinstance(value, type) and issubclass(value, messages())


def is_new(value: ast.expr | None, makers: set[str]) -> bool:
    """Whether an assigned value is created on the spot, so that no other code knows it; true for no value."""
    if value is None:
        return True
    if isinstance(value, ast.Call):
        maker = value.func.value if isinstance(value.func, ast.Subscript) else value.func  # Queue[str]()
        return ast.unparse(maker).split(".")[-1] in makers
    made = (ast.List, ast.Dict, ast.Set, ast.ListComp, ast.DictComp, ast.SetComp, ast.Constant, ast.BinOp)
    return isinstance(value, made)
