"""Slips in the source of a node class that Python runs without an error: what was written has no effect, or fails late.

A handler without its decorator, `self.rat = 2.0` beside a parameter `rate`, and `message.dat = ...`, or a text for a
number, in a message that a method has made or been given.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Collection, Iterator
from functools import cache
from typing import Any

from graphflow.deadlock.syntax import FunctionNode, syntax_of, walk
from graphflow.deadlock.user_code import is_users_module
from graphflow.deadlock.uses import is_own
from graphflow.errors import EncodeError, Place
from graphflow.msgs.base import Message, no_field
from graphflow.names import nearest
from graphflow.runtime import declared
from graphflow.runtime.twice import definition_of

_LIKE_A_HANDLER = re.compile(r"on_|handle_|.*(callback|_cb|_handler)$|(tick|timer)$")


@cache
def slips(cls: type) -> tuple[str, ...]:
    """A sentence for each, with its place; of the class and of those of the user's that it derives from."""
    found: list[str] = []
    for parent in cls.__mro__:
        source = definition_of(parent) if is_users_module(parent.__module__) else None
        if source is not None:
            definition, file = source
            mentioned = _mentioned(syntax_of(file).module)
            space = vars(sys.modules[parent.__module__])
            found += _idle_methods(parent, definition, file, mentioned, space)
            found += _stray_attributes(cls, definition, file, mentioned)
            for method in definition.body:
                if isinstance(method, FunctionNode):
                    found += _wrong_fields(method, file, space)
    return tuple(found)


def _mentioned(module: ast.Module) -> set[str]:
    """Attributes and names that a module reads, and words in its texts, by which an attribute may be found, too."""
    found: set[str] = set()
    for node in ast.walk(module):
        match node:
            case (
                ast.Attribute(attr=word, ctx=ast.Load())
                | ast.Name(id=word, ctx=ast.Load())
                | ast.Constant(value=str(word))
            ):
                found.add(word)
    return found


def _idle_methods(
    cls: type, definition: ast.ClassDef, file: str, mentioned: Collection[str], space: dict[str, Any]
) -> Iterator[str]:
    for method in definition.body:
        if not isinstance(method, FunctionNode) or method.decorator_list or method.name in mentioned:
            continue
        if method.name.startswith("__") or any(method.name in vars(parent) for parent in cls.__mro__[1:]):
            continue  # the parent calls it
        arguments = [a for a in (*method.args.posonlyargs, *method.args.args) if a.arg != "self"]
        kind = _received(arguments[0], space) if len(arguments) == 1 else ""
        if kind or (_LIKE_A_HANDLER.match(method.name) and len(arguments) <= 1):
            decorator = _DECORATORS.get(kind) or (_DECORATORS["message"] if arguments else "@timer(1.0)")
            yield (
                f"{Place(file, method.lineno)}: nothing calls {definition.name}.{method.name}, which looks like a "
                f"handler: declare it, as with {decorator} above it"
            )


_DECORATORS = {"message": '@subscription(Type, "topic")', "request": '@service(Type, "name")'}


def _received(argument: ast.arg, space: dict[str, Any]) -> str:
    """Whether an argument is annotated as a message or a request."""
    type_ = _message(argument.annotation, space)
    if type_ is None:
        return ""
    return "request" if type_.__name__ == "Request" or type_.SCHEMA.name.endswith("_Request") else "message"


def _resolved(expression: ast.expr | None, space: dict[str, Any]) -> Any:
    """What a name, or a name with dots, stands for in a module."""
    match expression:
        case ast.Name(id=name):
            return space.get(name)
        case ast.Attribute(value=value, attr=name):
            return getattr(_resolved(value, space), name)
        case ast.Constant(value=str(text)):
            return space.get(text)
    return None


def _stray_attributes(cls: type, definition: ast.ClassDef, file: str, mentioned: Collection[str]) -> Iterator[str]:
    """Attributes that are set, never read, and spelt almost as something that the class declares."""
    names = declared.held(cls)
    for method in definition.body:
        for node, parents in walk(method):
            if not (isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and is_own(node)):
                continue
            if node.attr in mentioned or hasattr(cls, node.attr) or any(isinstance(p, ast.ClassDef) for p in parents):
                continue
            near = nearest(node.attr, names, cutoff=0.75)
            if near is not None:
                yield f"{Place(file, node.lineno)}: self.{node.attr} is set and never read; did you mean self.{near}?"


def _wrong_fields(method: FunctionNode, file: str, space: dict[str, Any]) -> Iterator[str]:
    """Fields of messages made or received here that their type does not have, and literals that do not fit them."""
    arguments = {a.arg: _message(a.annotation, space) for a in method.args.args}
    made = {name: type_ for name, type_ in arguments.items() if type_ is not None}
    for node in ast.walk(method):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                type_ = _type_made(value, space)
                if name in made and made[name] is not type_:
                    return  # it is one thing here and another there
                if type_ is not None:
                    made[name] = type_
    for node in ast.walk(method):
        match node:
            case ast.Assign(targets=[ast.Attribute(value=ast.Name(id=name), attr=field)], value=value) if name in made:
                text = _misfit(made[name], field, value)
                if text:
                    yield f"{Place(file, node.lineno)}: {text}"


def _type_made(value: ast.expr, space: dict[str, Any]) -> type[Message] | None:
    """The message that an expression makes, as in `String()`."""
    return _message(value.func, space) if isinstance(value, ast.Call) else None


def _message(expression: ast.expr | None, space: dict[str, Any]) -> type[Message] | None:
    """The message class that an expression names."""
    try:
        type_ = _resolved(expression, space)
    except AttributeError:
        return None
    return type_ if isinstance(type_, type) and issubclass(type_, Message) else None


def _misfit(type_: type[Message], field: str, value: ast.expr) -> str:
    if field not in {f.name for f in type_.SCHEMA.fields}:
        return "" if hasattr(type_, field) else no_field(type_, field)
    try:
        literal = ast.literal_eval(value)
    except (ValueError, TypeError, SyntaxError):
        return ""
    try:
        type_(**{field: literal}).to_bytes()
    except EncodeError as error:
        return str(error)
    return ""
