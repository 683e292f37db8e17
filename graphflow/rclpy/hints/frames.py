"""The user's own frames of a traceback, and the objects in them, as hints inspect them."""

from __future__ import annotations

import linecache
import re
import sys
from types import FrameType

from graphflow.analysis.user_code import is_users
from graphflow.rclpy.messages.classes import StrictMessage

PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")
"""A name, or a dotted name."""


def own(frames: list[FrameType]) -> list[FrameType]:
    """Return the frames of the user's own code."""
    return [frame for frame in frames if is_users(frame.f_code.co_filename)]


def line_of(frames: list[FrameType]) -> str:
    """Return the source line of the user's code; empty if its file cannot be read."""
    found = own(frames)
    return linecache.getline(found[-1].f_code.co_filename, found[-1].f_lineno) if found else ""


def named(path: str, frame: FrameType) -> object:
    """Return the object of that name in a frame if no user code has to run to find it; else None."""
    first, *rest = path.split(".")
    thing: object = {**frame.f_globals, **frame.f_locals}.get(first)
    for part in rest:
        is_message = isinstance(thing, StrictMessage)
        thing = getattr(thing, part, None) if is_message else getattr(thing, "__dict__", {}).get(part)
    return thing


def is_defined_by_user(thing: object) -> bool:
    """Whether a class or function is the program's own, even if it shares its name with one of rclpy's."""
    name = getattr(thing, "__module__", None)
    file = getattr(sys.modules.get(str(name)), "__file__", None)
    # When an error is shown, "__main__" may be another module already.
    return name == "__main__" or (file is not None and is_users(file))


def lacking(error: BaseException, frames: list[FrameType]) -> tuple[object, str] | None:
    """Return the object and the attribute that it lacks."""
    found = re.match(r"'(\w+)' object has no attribute '(\w+)'", str(error))
    if not isinstance(error, AttributeError) or found is None:
        return None
    if error.name is not None:
        return error.obj, found[2]
    users = own(frames)
    for path in PATH.findall(line_of(frames)) if users else ():
        owner, _, attribute = path.rpartition(".")
        thing = named(owner, users[-1]) if attribute == found[2] and owner else None
        if type(thing).__name__ == found[1]:
            return thing, found[2]
    known = list(users[-1].f_locals.values()) if users else []
    known += [value for thing in known for value in getattr(thing, "__dict__", {}).values()]
    return next(((thing, found[2]) for thing in known if type(thing).__name__ == found[1]), None)
