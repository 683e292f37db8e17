"""Checks that declarations must pass when they are made; each error names the place and what to write instead.

Every check raises DeclarationError.
"""

from __future__ import annotations

import inspect
import sys
from typing import Any, get_args

from graphflow.errors import DeclarationError, InvalidName, Place
from graphflow.interface import OnError
from graphflow.msgs import base
from graphflow.msgs.base import Message
from graphflow.names import expand
from graphflow.qos import Qos

DEPTH = 10
"""The depth of a queue when none is given."""


def here(depth: int = 2) -> Place:
    """Where the calling function was called."""
    frame = sys._getframe(depth)
    return Place(frame.f_code.co_filename, frame.f_lineno)


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


def check_name(name: Any, what: str, place: Place) -> None:
    """Check that a name is legal."""
    if not isinstance(name, str):
        raise DeclarationError(f"{place}: {what}: the type comes first, then the name; {name!r} is not a name")
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


def check_on_event(on_event: Any, what: str, place: Place) -> None:
    """Check that `on_event` is a method."""
    if on_event is not None and not inspect.isfunction(on_event):
        raise DeclarationError(
            f"{place}: {what}: on_event= takes a method defined above it, `def noticed(self, event): ...`, "
            f"not {on_event!r}"
        )


def check_group(group: Any, kind: type, what: str, place: Place) -> None:
    """Check that a group is a declared one."""
    if group is not None and not isinstance(group, kind):
        raise DeclarationError(f"{place}: {what}: group= takes a Group, not {group!r}; declare one: io = Group(1)")


def check_on_error(on_error: Any, place: Place) -> None:
    """Check that there is such a rule for errors."""
    if on_error not in get_args(OnError):
        raise DeclarationError(f"{place}: on_error must be one of {', '.join(get_args(OnError))}, not {on_error!r}")
