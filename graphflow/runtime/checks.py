"""Checks that declarations must pass when they are made; each error names the place and what to write instead.

Every check raises DeclarationError.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, get_args

from graphflow.errors import DeclarationError, InvalidName, Place
from graphflow.interface import OnError
from graphflow.msgs import base
from graphflow.msgs.base import Message
from graphflow.names import expand
from graphflow.qos import Qos

DEPTH = 10
"""The depth of a queue when none is given."""


def check_type(type_: Any, kind: type, what: str, place: Place) -> None:
    """Check that `type_` is a message, service or action class."""
    if not (isinstance(type_, type) and issubclass(type_, kind)):
        hint = ""
        if kind is base.Service and isinstance(type_, type) and issubclass(type_, Message):
            hint = "; give the service's class, as in AddTwoInts, not its Request"
        elif isinstance(type_, str):
            hint = "; the type comes first, then the name"
        wanted = f"{'an' if kind is base.Action else 'a'} {kind.__name__.lower()} class"
        raise DeclarationError(f"{place}: {what} needs {wanted}, not {type_!r}{hint}")


def check_text(name: Any, what: str, place: Place) -> None:
    """Check that what stands in the place of a name is text."""
    if not isinstance(name, str):
        raise DeclarationError(f"{place}: {what}: the type comes first, then the name; {name!r} is not a name")


def check_name(name: Any, what: str, place: Place) -> None:
    """Check that a name is legal."""
    check_text(name, what, place)
    try:
        expand(name, "/", "node")
    except InvalidName as error:
        raise DeclarationError(f"{place}: {what}: {error}") from None


def check_qos(qos: Qos | int, depth: int | None, place: Place) -> Qos:
    """The requested profile, given as either `qos` or `depth`."""
    if depth is not None and qos != DEPTH:
        raise DeclarationError(f"{place}: give a Qos or a depth, not both: Qos(depth={depth!r}, ...) is both in one")
    asked = qos if depth is None else depth
    if not isinstance(asked, (Qos, int)):
        raise DeclarationError(f"{place}: give a Qos or a queue depth such as 10, not {asked!r}")
    try:
        return Qos.of(asked)
    except ValueError as error:
        raise DeclarationError(f"{place}: {error}") from None


def positional(fn: Any) -> tuple[list[str], int] | None:
    """The arguments that a function must be given by position, and how many it can be given; None: it does not say."""
    try:
        parameters = inspect.signature(fn).parameters.values()
    except (TypeError, ValueError):
        return None
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return None
    taken = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    return [p.name for p in taken if p.default is p.empty], len(taken)


def written_at(fn: Any) -> str:
    """Where a function is written, as `file:line`; empty for one that is not written in Python."""
    code = getattr(inspect.unwrap(fn), "__code__", None)
    return "" if code is None else str(Place(code.co_filename, code.co_firstlineno))


def check_callback(callback: Any, arguments: range, what: str, place: Place, hint: str = "") -> int:
    """Check that a handler can be called, with as many arguments as it will be given; returns with how many."""
    if not callable(callback):
        if inspect.iscoroutine(callback):
            callback.close()
        hint = "" if isinstance(callback, str) else "; pass the method itself, as in self.tick, without parentheses"
        raise DeclarationError(f"{place}: {what} needs a function to call, not {callback!r}{hint}")
    takes = positional(callback)
    if takes is None:
        return arguments[0]
    needed, most = takes
    fitting = [n for n in arguments if len(needed) <= n <= most]
    if not fitting:
        wanted = " or ".join(["no argument", "one argument", "two arguments"][n] for n in arguments)
        called = getattr(callback, "__qualname__", repr(callback))
        raise DeclarationError(
            f"{place}: {what}: {called} is called with {wanted}, but takes ({', '.join(needed)}){hint}"
        )
    return fitting[0]


def check_annotations(fn: Any, expected: Mapping[str, type], what: str, place: Place) -> None:
    """Check that a function is not written for messages of other types than those that it will be given.

    Args:
        expected: The classes of its arguments, after `self`, by what they are called.

    An annotation that is no message class is the user's affair.
    """
    parameters = list(inspect.signature(fn).parameters.values())[1:]
    for parameter, (called, wanted) in zip(parameters, expected.items(), strict=False):
        found = _annotated(fn, parameter.annotation)
        if isinstance(found, type) and issubclass(found, Message) and not issubclass(wanted, found):
            raise DeclarationError(
                f"{place}: {what}: {fn.__name__} is given {called}, and its argument "
                f"{parameter.name!r} is annotated {found.__name__.replace('_', '.')}; write the same in both"
            )


def _annotated(fn: Any, annotation: Any) -> Any:
    """The class that an annotation names; None for text that is no name known to the function's module."""
    if not isinstance(annotation, str):
        return annotation
    first, *others = annotation.strip("'\"").split(".")
    found = fn.__globals__.get(first)
    for name in others:
        found = getattr(found, name, None)
    return found


def check_on_event(on_event: Any, what: str, place: Place) -> None:
    """Check that `on_event` is a method."""
    if on_event is not None and not inspect.isfunction(on_event):
        raise DeclarationError(
            f"{place}: {what}: on_event= takes a method defined above it, `def noticed(self, event): ...`, "
            f"not {on_event!r}"
        )


def check_group(group: Any, kind: type | tuple[type, ...], what: str, place: Place) -> None:
    """Check that a group is a declared one."""
    if group is not None and not isinstance(group, kind):
        raise DeclarationError(f"{place}: {what}: group= takes a Group, not {group!r}; declare one: io = Group(1)")


def check_on_error(on_error: Any, place: Place) -> None:
    """Check that there is such a rule for errors."""
    if on_error not in get_args(OnError):
        raise DeclarationError(f"{place}: on_error must be one of {', '.join(get_args(OnError))}, not {on_error!r}")
