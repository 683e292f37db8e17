"""A forgotten `await` is told with the line that lacks it, on one line; Python's own warning names the scheduler's."""

from __future__ import annotations

import inspect
import linecache
import logging
import sys
import warnings
from collections.abc import Coroutine
from types import FrameType
from typing import Any

from graphflow.analysis.frames import stack_from
from graphflow.analysis.user_code import innermost, is_users

logger = logging.getLogger("graphflow")

TOLD_BOUND = 1000
"""Lines that are remembered, so that each is told once."""
_told: set[str] = set()


_AWAIT = "write await before it, in an async def"
_WAYS = {"GoalClient.send_goal": "write send in place of send_goal"}
"""Advice on an `async with` that begins with such a call."""


def watch() -> None:
    """Report coroutines that end without having been awaited."""
    # Python's C code looks this function up by its name.
    warnings._warn_unawaited_coroutine = report  # type: ignore[attr-defined]


def report(coroutine: Coroutine[Any, Any, Any]) -> None:
    """Log that a coroutine was never awaited, with the line that made it as far as it can be known."""
    name = getattr(coroutine, "__qualname__", repr(coroutine))
    frame = inspect.currentframe()  # has no caller where C code ends the coroutine, as at the end of Python
    place, text = _origin(coroutine, frame.f_back if frame is not None else None)
    if not place:
        # From here on Python notes where each coroutine is made. It costs 0.15 us for each.
        sys.set_coroutine_origin_tracking_depth(1)
    key = place or name
    if key in _told or len(_told) >= TOLD_BOUND:
        return
    _told.add(key)
    if place:
        logger.error(
            "%s: `%s` does nothing, since %s is a coroutine; %s",
            place,
            text,
            name,
            _WAYS.get(name, _AWAIT) if text.startswith("async with ") else _AWAIT,
        )
    else:
        logger.error(
            "a call of %s did nothing, since it was not awaited; should it happen again, its line will be told", name
        )


def _origin(coroutine: Any, ended_in: FrameType | None) -> tuple[str, str]:
    """Where a coroutine was made, as `file:line`, and that line; empty if that is not known."""
    for file, line, _ in coroutine.cr_origin or ():
        if is_users(file):
            return f"{file}:{line}", linecache.getline(file, line).strip()
    # A call whose result nobody keeps ends on the line on which it was made.
    frame = innermost(stack_from(ended_in))
    if frame is None:
        return "", ""
    text = linecache.getline(frame.f_code.co_filename, frame.f_lineno).strip()
    name = getattr(coroutine, "__name__", "")
    return (f"{frame.f_code.co_filename}:{frame.f_lineno}", text) if f"{name}(" in text else ("", "")
