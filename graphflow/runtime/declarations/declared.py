"""Declarations of a node class and its parents: merged, checked and converted to data."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import ClassVar, Protocol

from graphflow.analysis.user_code import is_users_module
from graphflow.errors import DeclarationError, Place
from graphflow.interface import (
    COMMON_PARAMETERS,
    EndpointInfo,
    GroupInfo,
    HandlerInfo,
    Interface,
    Parameter,
)
from graphflow.runtime.callables import code_of, file_of
from graphflow.runtime.declarations.declare import (
    HOOK_MARK,
    Declaration,
    Group,
    Param,
    ParamHook,
    Publisher,
    Subscription,
)
from graphflow.runtime.declarations.handlers import MARK, Handler
from graphflow.runtime.declarations.units import of_a_timer
from graphflow.runtime.failures import ErrorBudget


class NodeClass(Protocol):
    """The plain class attributes that configure a node class."""

    node_name: ClassVar[str]
    dynamic_names: ClassVar[bool | Sequence[str]]
    default_group: ClassVar[Group | None]
    is_managed: ClassVar[bool]


def snake_case(class_name: str) -> str:
    """Convert a class name to a node name: `TurtleSim` to `turtle_sim`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", class_name).lower()


def default_name(cls: type[NodeClass]) -> str:
    """Return the name of a node of the class made without one."""
    return cls.node_name or snake_case(cls.__name__)


def declarations(cls: type) -> dict[str, Declaration]:
    """Return the declarations of a class and its parents by attribute; a subclass's replace its parents'."""
    found: dict[str, Declaration] = {}
    for attribute, value in _members(cls):
        if isinstance(value, Declaration):
            found[attribute] = value
        elif attribute in found:
            lost = found.pop(attribute)
            if isinstance(value, (str, int, float, list, tuple, dict)):
                kind = type(lost).__name__
                way = f"{kind}({value!r})" if isinstance(lost, Param) else f"{kind}(TYPE, {value!r})"
                name = f"{cls.__module__}.{cls.__qualname__}"
                text = f"{attribute} = {value!r} replaces the {kind} of {lost.place}; write {attribute} = {way}"
                raise DeclarationError(f"{name}: {text}")
    return found


def handlers(cls: type) -> dict[str, Handler]:
    """Return the handlers of a class and its parents by method name.

    A subclass that overrides a handler without decorating it replaces only the body.
    """
    found: dict[str, Handler] = {}
    for attribute, value in _members(cls):
        mark = getattr(value, MARK, None)
        if isinstance(mark, Handler):
            found[attribute] = mark
        elif attribute in found and not inspect.isfunction(value):
            del found[attribute]
    return found


def param_hooks(cls: type) -> dict[str, ParamHook]:
    """Return the parameter hooks by method name; overriding works as for handlers."""
    found: dict[str, ParamHook] = {}
    for attribute, value in _members(cls):
        mark = getattr(value, HOOK_MARK, None)
        if isinstance(mark, ParamHook):
            found[attribute] = mark
        elif attribute in found and not inspect.isfunction(value):
            del found[attribute]
    return found


@cache
def hooks(cls: type) -> frozenset[str]:
    """Return the methods called outside any handler: parameter checks, event callbacks and goal decisions."""
    found: set[str] = {name for name, hook in param_hooks(cls).items() if hook.kind == "check"}
    called: list[object] = []
    for handler in handlers(cls).values():
        called += [handler.action.accept, handler.action.cancellable] if handler.action else []
    return event_hooks(cls) | found | {hook.__name__ for hook in called if inspect.isfunction(hook)}


def event_hooks(cls: type) -> frozenset[str]:
    """Return the methods that are called with the events of endpoints."""
    endpoints = (declared for declared in declarations(cls).values() if isinstance(declared, (Publisher, Subscription)))
    called = [item.on_event for item in (*endpoints, *handlers(cls).values())]
    return frozenset(hook.__name__ for hook in called if inspect.isfunction(hook))


_REDEFINED = {"default_group", "error_budget", "node_name", "dynamic_names", "on_start", "on_shutdown", "group"} | {
    "on_configure",
    "on_activate",
    "on_deactivate",
    "on_cleanup",
    "on_error",
}
"""Attributes that subclasses may redefine. A running `group` can also be released by its own name."""
_CLASS_VALUES = {"default_group": (Group, "Group(1)"), "error_budget": (ErrorBudget, "ErrorBudget(20, per=10.0)")}
"""The types of class attributes that may be None, each with an example."""


def reserved(node: type) -> set[str]:
    """Return the public attributes of a node, which no declaration and no method may hide."""
    return {name for name in dir(node) if not name.startswith("_")} - _REDEFINED | {"_core", "log", "parameters"}


def check_attributes(cls: type, node: type) -> None:
    """Check that nothing in a class hides a public attribute of nodes; methods that call `super` may.

    Args:
        node: The class `Node` itself.

    Raises:
        DeclarationError: An attribute does.
    """
    for attribute, (kind, example) in _CLASS_VALUES.items():
        if not isinstance(getattr(cls, attribute), kind | None):
            text = f"{attribute} is of the class {kind.__name__}: write {attribute} = {example}"
            raise DeclarationError(f"{place_of(cls)}: {text}")
    taken = reserved(node)
    found: dict[str, object] = {**declarations(cls), **handlers(cls), **groups(cls)}
    for attribute, value in vars(cls).items():
        code = code_of(value)
        is_override = code is not None and "super" in code.co_names
        is_meant = is_override or isinstance(value, property) or not is_users_module(cls.__module__)
        if not attribute.startswith("_") and not is_meant:
            found.setdefault(attribute, value)
    for attribute, declared in ((name, value) for name, value in found.items() if name in taken):
        hint = f", as in my_{attribute} = Param(..., name={attribute!r})" if isinstance(declared, Param) else ""
        if attribute == "name" and isinstance(declared, str):
            hint = f"; to name the nodes of the class write node_name = {declared!r}"
        code = code_of(declared)
        if isinstance(declared, (Declaration, Handler)):
            place = declared.place
        else:
            place = Place(code.co_filename, code.co_firstlineno) if code is not None else place_of(cls)
        raise DeclarationError(f"{place}: every node has {attribute!r}; choose another name{hint}")


def place_of(cls: type) -> Place:
    """Return the place of a class statement."""
    return Place(_file_of(cls), vars(cls).get("__firstlineno__", 0))


def _file_of(cls: type) -> str:
    """Return the file of a class's module, or the module's name."""
    return file_of(sys.modules.get(cls.__module__)) or cls.__module__


def groups(cls: type) -> dict[str, Group]:
    """Return the groups of a class and its parents by name."""
    return {name: value for name, value in _members(cls) if isinstance(value, Group)}


def _members(cls: type) -> Iterator[tuple[str, object]]:
    for parent in reversed(cls.__mro__):
        yield from vars(parent).items()


def class_line() -> int:
    """Return the line of the class statement being executed. To be called by `__init_subclass__`.

    Python 3.13 and later have `__firstlineno__`; finding the line in the source takes milliseconds per class.
    """
    frame = sys._getframe(1)
    while frame.f_code.co_name == "__init_subclass__" and frame.f_back is not None:
        frame = frame.f_back
    return frame.f_lineno


def interface_of(cls: type[NodeClass]) -> Interface:
    """Convert a node class's declarations to data.

    Raises:
        DeclarationError: Two declarations contradict each other.
    """
    place = _source_place(cls)
    params, methods = _params(cls), handlers(cls)
    endpoints = [endpoint for declared in declarations(cls).values() for endpoint in declared.endpoints()]
    for attribute, handler in methods.items():
        _check_rate(cls, attribute, handler, params)
        if handler.kind in ("subscription", "service", "action"):
            endpoints.append(_method(attribute, handler, endpoints))
    dynamic = cls.dynamic_names
    _check_patterns(place, () if isinstance(dynamic, bool) else dynamic)
    return Interface(
        class_path=f"{cls.__module__}:{cls.__qualname__}",
        node_name=default_name(cls),
        place=place,
        doc=inspect.cleandoc(cls.__doc__ or ""),
        endpoints=tuple(endpoints),
        params=tuple(params.values()),
        handlers=tuple(_handler(cls, name, handler) for name, handler in methods.items()),
        groups={name: GroupInfo(g.limit, g.when_full, g.thread) for name, g in groups(cls).items()},
        dynamic_names=dynamic if isinstance(dynamic, bool) else tuple(dynamic),
        is_managed=cls.is_managed,
        attributes=tuple(declarations(cls)),
    )


def _source_place(cls: type) -> Place:
    line: int = vars(cls).get("__firstlineno__", 0)
    try:
        return Place(inspect.getsourcefile(cls) or "", line or inspect.getsourcelines(cls)[1])
    except (OSError, TypeError):  # no source, as in an interactive session
        return Place(_file_of(cls))


def _params(cls: type) -> dict[str, Parameter]:
    """Return the parameters of a class by name. Raises DeclarationError for a name that is taken."""
    found: dict[str, Parameter] = {}
    for parameter in (declared.parameter for declared in declarations(cls).values() if isinstance(declared, Param)):
        if parameter.name in COMMON_PARAMETERS:
            raise DeclarationError(
                f"{parameter.place}: every node has the parameter {parameter.name!r}; rename this one"
            )
        if parameter.name in found:
            raise DeclarationError(f"{parameter.place}: {cls.__name__} declares the parameter {parameter.name!r} twice")
        found[parameter.name] = parameter
    return found


def _check_rate(cls: type, attribute: str, handler: Handler, params: Mapping[str, Parameter]) -> None:
    if handler.rate is None:
        return
    for name in handler.rate.parameters():
        if name not in params:
            text = f"{attribute} reads its period from the parameter {name!r}, which {cls.__name__} does not have"
            raise DeclarationError(f"{handler.place}: {text}")
    for source, taken in handler.rate.sources():
        if text := of_a_timer(source.parameter, taken):
            raise DeclarationError(f"{handler.place}: {text}")


def _method(attribute: str, handler: Handler, endpoints: Iterable[EndpointInfo]) -> EndpointInfo:
    """Return the endpoint of a handler. Raises DeclarationError if a service or action is offered twice."""
    assert handler.kind in ("subscription", "service", "action")
    same = [e for e in endpoints if (e.kind, e.name) == (handler.kind, handler.name) and e.kind != "subscription"]
    if same:
        raise DeclarationError(
            f"{handler.place}: {attribute} offers the {handler.kind} {handler.name!r}, which {same[0].attribute} "
            f"({same[0].place}) already offers; a client reaches only one of them"
        )
    type_name = handler.type.SCHEMA.name if handler.kind == "subscription" else handler.type.NAME
    return EndpointInfo(handler.kind, handler.name, type_name, attribute, handler.place)


def _check_patterns(place: Place, patterns: Iterable[str]) -> None:
    for pattern in patterns:
        if pattern[:1] not in ("/", "*", "?", "["):
            raise DeclarationError(
                f"{place}: dynamic_names: {pattern!r} would match nothing, since patterns are compared with full "
                f"names; write '*/{pattern}'"
            )


def _handler(cls: type[NodeClass], attribute: str, handler: Handler) -> HandlerInfo:
    # A subclass may have replaced only the body, by an `async def` or a `def` in another place.
    function = inspect.unwrap(getattr(cls, attribute))
    code = code_of(function)
    place = handler.place if code is None else Place(code.co_filename, code.co_firstlineno)
    group = None if handler.kind == "task" else handler.group or cls.default_group
    is_async = inspect.iscoroutinefunction(function)
    return HandlerInfo(attribute, handler.kind, place, group.name if group else "", is_async, handler.thread)
