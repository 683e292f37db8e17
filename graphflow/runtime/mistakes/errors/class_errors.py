"""Message classes that are used in place of messages: `twist = Twist`, then `twist.linear.x = 2.0`.

The class's fields are descriptors, and Python's error names only those.
"""

from __future__ import annotations

import linecache
import re
from types import FrameType

from graphflow.analysis.user_code import is_users, parts_of
from graphflow.msgs.base import Message

_DESCRIPTOR = re.compile(r"'(member_descriptor|getset_descriptor|property)'")
_PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+")
"""A dotted name."""


def class_in_place(error: BaseException) -> str:
    """Return a sentence if an error comes from a field of a message class; "" for any other."""
    if not isinstance(error, (AttributeError, TypeError)) or not _DESCRIPTOR.search(str(error)):
        return ""
    own = [p for p in parts_of(error.__traceback__) if is_users(p.tb_frame.f_code.co_filename)]
    if not own:
        return ""
    frame = own[-1].tb_frame
    for path in _PATH.findall(linecache.getline(frame.f_code.co_filename, own[-1].tb_lineno)):
        parts = path.split(".")
        for end in range(1, len(parts)):
            thing, name = _named(parts[:end], frame), ".".join(parts[:end])
            if isinstance(thing, type) and issubclass(thing, Message) and parts[end] in vars(thing):
                if name == thing.__name__:
                    return f"{name} is a class, not a message: write {name}(), or use a message"
                return f"{name} is the class {thing.__name__}, not a message: write {name} = {thing.__name__}()"
    return ""


def _named(path: list[str], frame: FrameType) -> object:
    """Return the object that a dotted name refers to in a frame; None if finding it would run user code."""
    thing = {**frame.f_globals, **frame.f_locals}.get(path[0])
    for part in path[1:]:
        thing = getattr(thing, "__dict__", {}).get(part)
    return thing
