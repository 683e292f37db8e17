"""A transform buffer that is queried but never filled: it has no listener, or is a new one in each call.

In ROS 2 every lookup fails because the frame does not exist.
"""

from __future__ import annotations

import logging
import sys
import time
from collections import Counter
from collections.abc import Iterator
from types import FrameType

from graphflow.analysis.syntax import syntax_of
from graphflow.analysis.user_code import is_installed, is_users, short_place, users_frame
from graphflow.errors import Place
from rclpy.impl.callers import caller
from rclpy.impl.deadlock.stacks import is_in_run

WARN_AFTER = 1.0
"""Seconds from the first failed lookup: a listener may be created after it."""
_FILLERS = ("set_transform", "set_transform_static")
logger = logging.getLogger("graphflow")


_made = Counter[Place]()
"""The number of buffers that each line has created in callbacks."""


def warn_of_new() -> None:
    """Warn of a buffer that a callback creates for the second time: a new one holds no transforms yet."""
    asked = caller(2)
    if asked is None or not is_in_run(asked.frame):
        return
    _made[asked.place] += 1
    if _made[asked.place] == 2:
        way = "create it and its TransformListener in __init__, and keep both in attributes"
        logger.warning("%s: each call creates a new Buffer, which holds no transforms yet: %s", asked.place, way)


class Unfilled:
    """The sources of one buffer's transforms."""

    def __init__(self) -> None:
        self.is_filled = False
        """Whether there was ever a listener, or a transform."""
        self.remark = ""
        """The remedy, once it has been reported."""
        self._since: float | None = None

    def lookup_failed(self, buffer: object) -> None:
        """Note a failed lookup."""
        now = time.monotonic()
        if self._since is None:
            self._since = now
        if self.is_filled or self.remark or now - self._since < WARN_AFTER:
            return
        if any(_names_a_filler(file) for file in _users_files()):
            self.is_filled = True  # it may be yet
            return
        frame = users_frame(sys._getframe(1))
        name = _name(buffer, frame)
        self.remark = f"nothing fills this Buffer; write in __init__ self.listener = TransformListener({name}, self)"
        place = "" if frame is None else f"{short_place(frame.f_code.co_filename, frame.f_lineno)}: "
        logger.warning("%s%s", place, self.remark)


def _users_files() -> Iterator[str]:
    for module in list(sys.modules.values()):
        file: str | None = getattr(module, "__file__", None)
        if file is not None and file.endswith(".py") and is_users(file) and not is_installed(file):
            yield file


def _names_a_filler(file: str) -> bool:
    try:
        return any(getattr(node, "attr", "") in _FILLERS for node, _ in syntax_of(file).parts)
    except (OSError, SyntaxError, ValueError):  # its source is not available
        return True


def _name(buffer: object, frame: FrameType | None) -> str:
    """Return the expression by which the calling code names a buffer."""
    own = frame.f_locals.get("self") if frame is not None else None
    names = [name for name, value in getattr(own, "__dict__", {}).items() if value is buffer]
    return f"self.{names[0]}" if names else "buffer"
