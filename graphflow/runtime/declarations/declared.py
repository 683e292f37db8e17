"""Declarations of a node class and its parents: merged, checked and converted to data."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any, ClassVar, Protocol

from graphflow.analysis.user_code import is_users_module
from graphflow.errors import DeclarationError, Place
from graphflow.interface import COMMON_PARAMETERS, EndpointInfo, GroupInfo, HandlerInfo, Interface, Parameter
from graphflow.runtime.declarations.declare import (
    HOOK_MARK,
    ActionClient,
    Client,
    Group,
    Held,
    Param,
    ParamHook,
    Publisher,
    Subscription,
)
from graphflow.runtime.declarations.handlers import MARK, Handler


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


def held(cls: type) -> dict[str, Held]:
    """Return the declarations of a class and its parents by attribute; a subclass's replace its parents'."""
    found: dict[str, Held] = {}
    for attribute, value in _members(cls):
        if isinstance(value, Held):
            found[attribute] = value
        else:
            found.pop(attribute, None)
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
    called: list[Any] = [getattr(declared, "on_event", None) for declared in held(cls).values()]
    for handler in handlers(cls).values():
        called += [handler.on_event]
        called += [handler.action.accept, handler.action.cancellable] if handler.action else []
    return frozenset(found | {hook.__name__ for hook in called if inspect.isfunction(hook)})


_REDEFINED = {"default_group", "error_budget", "node_name", "dynamic_names", "on_start", "on_shutdown", "group"} | {
    "on_configure",
    "on_activate",
    "on_deactivate",
    "on_cleanup",
    "on_error",
}
"""Attributes that subclasses may redefine. A running `group` can also be released by its own name."""


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
    taken = reserved(node)
    found: dict[str, Any] = {**held(cls), **handlers(cls), **groups(cls)}
    for attribute, value in vars(cls).items():
        function = getattr(value, "__func__", value)  # unwraps classmethod and staticmethod
        is_override = inspect.isfunction(function) and "super" in function.__code__.co_names
        is_meant = is_override or isinstance(value, property) or not is_users_module(cls.__module__)
        if not attribute.startswith("_") and not is_meant:
            found.setdefault(attribute, value)
    for attribute, declared in ((name, value) for name, value in found.items() if name in taken):
        hint = f", as in my_{attribute} = Param(..., name={attribute!r})" if isinstance(declared, Param) else ""
        if attribute == "name" and isinstance(declared, str):
            hint = f"; to name the nodes of the class write node_name = {declared!r}"
        code = getattr(getattr(declared, "__func__", declared), "__code__", None)
        place = getattr(declared, "place", None) or (
            Place(code.co_filename, code.co_firstlineno) if code is not None else place_of(cls)
        )
        raise DeclarationError(f"{place}: every node has {attribute!r}; choose another name{hint}")


def place_of(cls: type) -> Place:
    """Return the place of a class statement."""
    module = sys.modules.get(cls.__module__)
    return Place(getattr(module, "__file__", None) or cls.__module__, vars(cls).get("__firstlineno__", 0))


def groups(cls: type) -> dict[str, Group]:
    """Return the groups of a class and its parents by name."""
    return {name: value for name, value in _members(cls) if isinstance(value, Group)}


def _members(cls: type) -> Iterator[tuple[str, Any]]:
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
    line: int = vars(cls).get("__firstlineno__", 0)
    try:
        place = Place(inspect.getsourcefile(cls) or "", line or inspect.getsourcelines(cls)[1])
    except (OSError, TypeError):
        place = Place(getattr(sys.modules.get(cls.__module__), "__file__", None) or cls.__module__)
    endpoints: list[EndpointInfo] = []
    params: dict[str, Parameter] = {}
    kinds = {
        Publisher: "publisher",
        Subscription: "subscription",
        Client: "client",
        ActionClient: "action client",
    }
    for attribute, declared in held(cls).items():
        if isinstance(declared, Param):
            p = declared.parameter
            if p.name in COMMON_PARAMETERS:
                raise DeclarationError(
                    f"{p.place}: every node has the parameter {p.name!r}; give this one another name"
                )
            if p.name in params:
                raise DeclarationError(f"{p.place}: {cls.__name__} declares the parameter {p.name!r} twice")
            params[p.name] = p
        elif isinstance(declared, (Publisher, Subscription, Client, ActionClient)):
            is_topic = isinstance(declared, (Publisher, Subscription))
            type_name = declared.type.SCHEMA.name if is_topic else declared.type.NAME  # type: ignore[union-attr]
            kind: Any = kinds[type(declared)]
            group = declared.group.name if isinstance(declared, Client) and declared.group is not None else ""
            endpoints.append(EndpointInfo(kind, declared.name, type_name, attribute, declared.place, group))
    methods = handlers(cls)
    for attribute, handler in methods.items():
        for name in handler.rate.parameters() if handler.rate is not None else ():
            if name not in params:
                text = f"{attribute} reads its period from the parameter {name!r}, which {cls.__name__} does not have"
                raise DeclarationError(f"{handler.place}: {text}")
        if handler.kind in ("subscription", "service", "action"):
            type_name = handler.type.SCHEMA.name if handler.kind == "subscription" else handler.type.NAME
            kind = handler.kind
            same = [e for e in endpoints if (e.kind, e.name) == (kind, handler.name) and kind != "subscription"]
            if same:
                raise DeclarationError(
                    f"{handler.place}: {attribute} offers the {kind} {handler.name!r}, which {same[0].attribute} "
                    f"({same[0].place}) offers already; a client reaches one of them only"
                )
            endpoints.append(EndpointInfo(kind, handler.name, type_name, attribute, handler.place))
    dynamic = cls.dynamic_names
    for pattern in () if isinstance(dynamic, bool) else dynamic:
        if pattern[:1] not in ("/", "*", "?", "["):
            raise DeclarationError(
                f"{place}: dynamic_names: {pattern!r} would match nothing, since patterns are compared with full "
                f"names; write '*/{pattern}'"
            )
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
    )


def _handler(cls: type[NodeClass], attribute: str, handler: Handler) -> HandlerInfo:
    # A subclass may have replaced only the body, by an `async def` or a `def` in another place.
    function = inspect.unwrap(getattr(cls, attribute))
    code = getattr(function, "__code__", None)
    place = handler.place if code is None else Place(code.co_filename, code.co_firstlineno)
    group = None if handler.kind == "task" else handler.group or cls.default_group
    is_async = inspect.iscoroutinefunction(function)
    return HandlerInfo(attribute, handler.kind, place, group.name if group else "", is_async, handler.thread)
