"""What a class makes by `self.create_...` in its methods, read from their source: known before a node is made.

Literal names are read, and names of constants of the module or the class. Where a name cannot be read, its place is
kept, so that checks can say what they do not know.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from types import FunctionType
from typing import Any, NamedTuple

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import first_line, syntax_of
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import ParameterError, Place
from graphflow.interface import EndpointInfo, EndpointKind, HandlerInfo, HandlerKind, Interface, Parameter, type_of


class _Maker(NamedTuple):
    """One of the methods that make something: what, and where in its arguments the name and the handler stand."""

    kind: EndpointKind | HandlerKind | None
    name: int | None
    handler: int | None = None


_MAKERS = {
    "create_publisher": _Maker("publisher", 1),
    "create_subscription": _Maker("subscription", 1, 2),
    "create_service": _Maker("service", 1, 2),
    "create_client": _Maker("client", 1),
    "create_action_server": _Maker("action", 1, 2),
    "create_action_client": _Maker("action client", 1),
    "create_timer": _Maker("timer", None, 1),
    "declare_parameter": _Maker(None, 0),
}


def with_made(cls: type, interface: Interface) -> Interface:
    """An interface, and with it what the methods of its class make."""
    made, declared = _made(cls), {h.name for h in interface.handlers}
    return replace(
        interface,
        node_name=made.node_name or interface.node_name,
        endpoints=(*interface.endpoints, *made.endpoints),
        params=(*interface.params, *(p for p in made.params if interface.param(p.name) is None)),
        handlers=(*interface.handlers, *(h for h in made.handlers if h.name not in declared)),
        unread=tuple(made.unread),
    )


class _Made:
    """What is found in the methods of one class."""

    def __init__(self) -> None:
        self.node_name = ""
        self.endpoints: list[EndpointInfo] = []
        self.params: list[Parameter] = []
        self.handlers: list[HandlerInfo] = []
        self.unread: list[Place] = []

    def read(self, cls: type, function: FunctionType) -> None:
        """Take in what one method makes."""
        file = function.__code__.co_filename
        syntax = _syntax(function)
        if syntax is None:
            return
        for node in ast.walk(syntax):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                if function.__name__ == "__init__" and node.func.attr == "__init__":
                    self._read_name(node, function)
                elif is_own(node.func) and node.func.attr in _MAKERS:
                    self._read_call(cls, node, function, Place(file, node.lineno), _kept_as(node, syntax))

    def _read_name(self, call: ast.Call, function: FunctionType) -> None:
        """`super().__init__("talker")`: the name that the class gives itself."""
        own = call.func.value  # type: ignore[attr-defined]
        arguments = call.args if isinstance(own, ast.Call) else call.args[1:]
        name = _argument(call, 0, "name") if isinstance(own, ast.Call) else next(iter(arguments), None)
        text = _text(name, function, None)
        if text:
            self.node_name = text

    def _read_call(self, cls: type, call: ast.Call, function: FunctionType, place: Place, attribute: str) -> None:
        maker = _MAKERS[call.func.attr]  # type: ignore[attr-defined]
        handler = "" if maker.handler is None else _method(_argument(call, maker.handler, "callback"), cls)
        if handler:
            method = inspect.unwrap(getattr(cls, handler))
            where = Place(method.__code__.co_filename, method.__code__.co_firstlineno)
            is_async = inspect.iscoroutinefunction(method)
            group = _group(_argument(call, None, "group"), cls)
            thread = _argument(call, None, "thread")
            threaded = isinstance(thread, ast.Constant) and thread.value is True
            kind: Any = maker.kind
            self.handlers.append(HandlerInfo(handler, kind, where, group, is_async, threaded))
        if maker.name is None:
            return
        name = _text(_argument(call, maker.name, "name"), function, cls)
        if name is None:
            self.unread.append(place)
        elif maker.kind is None:
            self.params.append(_parameter(call, name, place))
        else:
            type_name = _type(_argument(call, 0, "type_"), function)
            kind = maker.kind
            self.endpoints.append(EndpointInfo(kind, name, type_name, handler or attribute, place))


@cache
def _made(cls: type) -> _Made:
    made = _Made()
    for parent in reversed(cls.__mro__):
        if not is_users_module(parent.__module__):
            continue
        for name, value in vars(parent).items():
            function = inspect.unwrap(value) if inspect.isfunction(value) else None
            # What a parent's method makes, unless the class has replaced it.
            if isinstance(function, FunctionType) and (getattr(cls, name, None) is value or name == "__init__"):
                made_here = set(function.__code__.co_names)
                if made_here & _MAKERS.keys() or name == "__init__":
                    made.read(cls, function)
    return made


def _syntax(function: FunctionType) -> ast.AST | None:
    code = function.__code__
    try:
        syntax = syntax_of(code.co_filename)
    except (OSError, SyntaxError, ValueError):
        return None
    for node in syntax.functions:
        if first_line(node) == code.co_firstlineno and node.name == code.co_name:
            return node
    return None


def _argument(call: ast.Call, at: int | None, word: str) -> ast.expr | None:
    """An argument by its place or its word."""
    if at is not None and len(call.args) > at:
        return None if any(isinstance(a, ast.Starred) for a in call.args[: at + 1]) else call.args[at]
    return next((k.value for k in call.keywords if k.arg == word), None)


def _text(node: ast.expr | None, function: FunctionType, cls: type | None) -> str | None:
    """The string that an expression surely is: a literal, or a constant of the module or the class."""
    found: Any = None
    if isinstance(node, ast.Constant):
        found = node.value
    elif isinstance(node, ast.Name) and node.id.isupper():
        found = function.__globals__.get(node.id)
    elif isinstance(node, ast.Attribute) and is_own(node) and node.attr.isupper() and cls is not None:
        found = getattr(cls, node.attr, None)
    return found if isinstance(found, str) else None


def _type(node: ast.expr | None, function: FunctionType) -> str:
    """The name of a message, service or action type; empty when it cannot be told."""
    found: Any = None
    words = ast.unparse(node).split(".") if isinstance(node, (ast.Name, ast.Attribute)) else []
    if words:
        found = function.__globals__.get(words[0])
        for word in words[1:]:
            found = getattr(found, word, None)
    schema = getattr(found, "SCHEMA", None)
    name = getattr(schema, "name", None) or getattr(found, "NAME", None)
    return name if isinstance(name, str) else ""


def _method(node: ast.expr | None, cls: type) -> str:
    """The method of the class that is passed: `self.heard`."""
    if node is not None and is_own(node) and inspect.isfunction(getattr(cls, node.attr, None)):  # type: ignore[attr-defined]
        return str(node.attr)  # type: ignore[attr-defined]
    return ""


def _group(node: ast.expr | None, cls: type) -> str:
    """The name of the group that is passed; else that of the class's default."""
    if node is not None and is_own(node):
        return str(node.attr)  # type: ignore[attr-defined]
    default = getattr(cls, "default_group", None)
    return default.name if default is not None and node is None else ""


def _parameter(call: ast.Call, name: str, place: Place) -> Parameter:
    """A parameter as far as the call shows it: without a literal default, one that takes anything."""
    default = _argument(call, 1, "default")
    try:
        value = ast.literal_eval(default) if default is not None else None
        return Parameter(name, type_of(value), value, place)
    except (ValueError, ParameterError):
        return Parameter(name, "str", None, place, dynamic=True)


def _kept_as(call: ast.Call, function: ast.AST) -> str:
    """The attribute that a call's result is assigned to: `self.client = self.create_client(...)`."""
    for node in _assignments(function):
        if node.value is call:
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            return next((t.attr for t in targets if is_own(t)), "")  # type: ignore[attr-defined]
    return ""


def _assignments(function: ast.AST) -> Iterator[ast.Assign | ast.AnnAssign]:
    for node in ast.walk(function):
        if isinstance(node, (ast.Assign, ast.AnnAssign)):
            yield node
