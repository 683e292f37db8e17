"""Endpoints, parameters and timers that a class creates by `self.create_...`, read from source without a node.

Names may be literals, or constants of the module or the class. A call with any other name is kept as a place, so that
checks can list what they do not know.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from types import FunctionType
from typing import NamedTuple

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import first_line, last_name, nodes_in, syntax_of
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import ParameterError, Place
from graphflow.interface import EndpointInfo, EndpointKind, HandlerInfo, HandlerKind, Interface, Parameter, type_of


class _Maker(NamedTuple):
    """One of the `create_...` methods."""

    kind: EndpointKind | None
    """Kind of the endpoint; None for a timer or a parameter."""
    name: int | None
    """Position of the name among its arguments."""
    handler: tuple[HandlerKind, int] | None = None
    """Kind of the handler, and its position among the arguments."""


_MAKERS = {
    "create_publisher": _Maker("publisher", 1),
    "create_subscription": _Maker("subscription", 1, ("subscription", 2)),
    "create_service": _Maker("service", 1, ("service", 2)),
    "create_client": _Maker("client", 1),
    "create_action_server": _Maker("action", 1, ("action", 2)),
    "create_action_client": _Maker("action client", 1),
    "create_timer": _Maker(None, None, ("timer", 1)),
    "declare_parameter": _Maker(None, 0),
}


def with_made(cls: type, interface: Interface) -> Interface:
    """Return an interface with everything that the methods of its class create."""
    made, declared = _made(cls), {h.name for h in interface.handlers}
    return replace(
        interface,
        node_name=made.node_name or interface.node_name,
        endpoints=(*interface.endpoints, *made.endpoints),
        params=(*interface.params, *(p for p in made.params if interface.param(p.name) is None)),
        handlers=(*interface.handlers, *(h for h in made.handlers if h.name not in declared)),
        unread=tuple(made.unread),
        made_params=tuple(made.param_patterns),
    )


class _Made:
    """The calls found in the methods of one class."""

    def __init__(self) -> None:
        self.node_name = ""
        self.endpoints: list[EndpointInfo] = []
        self.params: list[Parameter] = []
        self.handlers: list[HandlerInfo] = []
        self.unread: list[Place] = []
        self.param_patterns: list[str] = []

    def read(self, cls: type, function: FunctionType) -> None:
        """Read the calls in one method."""
        file = function.__code__.co_filename
        syntax = _syntax(function)
        if syntax is None:
            return
        for node in nodes_in(syntax):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                if function.__name__ == "__init__" and node.func.attr == "__init__":
                    self._read_name(node, function)
                elif is_own(node.func) and node.func.attr in _MAKERS:
                    self._read_call(cls, node, function, Place(file, node.lineno), _kept_as(node, syntax))

    def _read_name(self, call: ast.Call, function: FunctionType) -> None:
        """Read the node's name from `super().__init__("talker")` or `Node.__init__(self, "talker")`."""
        is_super = isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Call)
        name = _argument(call, 0, "name") if is_super else next(iter(call.args[1:]), None)
        text = _text(name, function, None)
        if text:
            self.node_name = text

    def _read_call(self, cls: type, call: ast.Call, function: FunctionType, place: Place, attribute: str) -> None:
        """Read one call; the created object is kept in `self.attribute`, if that is not empty."""
        maker = _MAKERS[last_name(call.func)]
        handler = "" if maker.handler is None else self._read_handler(cls, call, *maker.handler)
        if maker.name is None:
            return
        given = _argument(call, maker.name, "name")
        name = _text(given, function, cls)
        if name is None and last_name(call.func) == "declare_parameter":
            self.param_patterns.append(_pattern(given, function, cls))
        elif name is None:
            self.unread.append(place)
        elif maker.kind is None:
            self.params.append(_parameter(call, name, place))
        else:
            type_name = _type(_argument(call, 0, "type_"), function)
            self.endpoints.append(EndpointInfo(maker.kind, name, type_name, handler or attribute, place, is_made=True))

    def _read_handler(self, cls: type, call: ast.Call, kind: HandlerKind, at: int) -> str:
        """Read the handler that a call passes; return its name, which is empty if it is no method of the class."""
        name = _method(_argument(call, at, "callback"), cls)
        if name:
            method = inspect.unwrap(getattr(cls, name))
            where = Place(method.__code__.co_filename, method.__code__.co_firstlineno)
            group = _group(_argument(call, None, "group"), cls)
            thread = _argument(call, None, "thread")
            is_threaded = isinstance(thread, ast.Constant) and thread.value is True
            is_async = inspect.iscoroutinefunction(method)
            self.handlers.append(HandlerInfo(name, kind, where, group, is_async, is_threaded))
        return name


@cache
def _made(cls: type) -> _Made:
    made = _Made()
    for parent in reversed(cls.__mro__):
        if not is_users_module(parent.__module__):
            continue
        for name, value in vars(parent).items():
            function = inspect.unwrap(value) if inspect.isfunction(value) else None
            # A parent's method counts unless the class overrides it; constructors call each other.
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


def _argument(call: ast.Call, at: int | None, keyword: str) -> ast.expr | None:
    """Return an argument by position or keyword."""
    if at is not None and len(call.args) > at:
        return None if any(isinstance(a, ast.Starred) for a in call.args[: at + 1]) else call.args[at]
    return next((k.value for k in call.keywords if k.arg == keyword), None)


def _text(node: ast.expr | None, function: FunctionType, cls: type | None) -> str | None:
    """Return the string value of a literal, or of a constant of the module or the class; None for anything else."""
    found: object = None
    if isinstance(node, ast.Constant):
        found = node.value
    # Only names in capitals: any other may be bound again.
    elif isinstance(node, ast.Name) and node.id.isupper():
        found = function.__globals__.get(node.id)
    elif isinstance(node, ast.Attribute) and is_own(node) and node.attr.isupper() and cls is not None:
        found = getattr(cls, node.attr, None)
    return found if isinstance(found, str) else None


def _pattern(node: ast.expr | None, function: FunctionType, cls: type) -> str:
    """Return the pattern of a text that is made at run time: `*.radius` of `f"{wheel}.radius"`."""
    match node:
        case ast.JoinedStr(values=parts):
            return "".join(_pattern(part, function, cls) for part in parts)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _pattern(left, function, cls) + _pattern(right, function, cls)
    text = _text(node, function, cls)
    return "*" if text is None else "".join(f"[{c}]" if c in "*?[" else c for c in text)


def _type(node: ast.expr | None, function: FunctionType) -> str:
    """Return the name of a message, service or action type; empty if it is not known."""
    found: object = None
    path = ast.unparse(node).split(".") if isinstance(node, (ast.Name, ast.Attribute)) else []
    if path:
        found = function.__globals__.get(path[0])
        for part in path[1:]:
            found = getattr(found, part, None)
    schema = getattr(found, "SCHEMA", None)
    name = getattr(schema, "name", None) or getattr(found, "NAME", None)
    return name if isinstance(name, str) else ""


def _method(node: ast.expr | None, cls: type) -> str:
    """Return the name of the method that is passed, as in `self.heard`; empty for anything else."""
    if node is not None and is_own(node) and inspect.isfunction(getattr(cls, node.attr, None)):
        return node.attr
    return ""


def _group(node: ast.expr | None, cls: type) -> str:
    """Return the name of the group that is passed, or else of the class's default group."""
    if node is not None and is_own(node):
        return node.attr
    default = getattr(cls, "default_group", None)
    return default.name if default is not None and node is None else ""


def _parameter(call: ast.Call, name: str, place: Place) -> Parameter:
    """Return the parameter that a call declares; without a literal default it is dynamic."""
    default = _argument(call, 1, "default")
    try:
        value = ast.literal_eval(default) if default is not None else None
        return Parameter(name, type_of(value), value, place)
    except (ValueError, ParameterError):
        return Parameter(name, "str", None, place, dynamic=True)


def _kept_as(call: ast.Call, function: ast.AST) -> str:
    """Return the attribute of `self.client = self.create_client(...)`; empty if there is none."""
    for node in _assignments(function):
        if node.value is call:
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            return next((t.attr for t in targets if is_own(t)), "")
    return ""


def _assignments(function: ast.AST) -> Iterator[ast.Assign | ast.AnnAssign]:
    for node in nodes_in(function):
        if isinstance(node, (ast.Assign, ast.AnnAssign)):
            yield node
