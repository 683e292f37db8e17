"""Forgotten `await`s, reported in one line with the place of the call; Python's warning has the scheduler's."""

from __future__ import annotations

import inspect
import linecache
import logging
import re
import sys
import warnings
from collections.abc import Coroutine
from types import CodeType, FrameType
from typing import Any

from graphflow.analysis.frames import stack_from
from graphflow.analysis.user_code import innermost, is_users

logger = logging.getLogger("graphflow")

PLACES_BOUND = 1000
"""Lines of code remembered, so that each is reported once."""
_reported: set[str] = set()


_AWAIT = "write await before it, in an async def"
_WAYS = {"GoalClient.send_goal": "write send instead of send_goal"}
"""Advice on an `async with` that starts with such a call."""


def watch() -> None:
    """Report coroutines that end without having been awaited."""
    # CPython's C code looks up this function by name.
    warnings._warn_unawaited_coroutine = report  # type: ignore[attr-defined]


def report(coroutine: Coroutine[object, object, object]) -> None:
    """Log that a coroutine was never awaited, with the line that called its function, if known."""
    name = getattr(coroutine, "__qualname__", repr(coroutine))
    frame = inspect.currentframe()  # there is no caller when C code finalizes the coroutine, as at interpreter exit
    place, text = _origin(coroutine, frame.f_back if frame is not None else None)
    if not place:
        # From here on, Python records where each coroutine is created, at 0.15 us each.
        sys.set_coroutine_origin_tracking_depth(1)
    key = place or name
    if key in _reported or len(_reported) >= PLACES_BOUND:
        return
    _reported.add(key)
    if place:
        logger.error(
            "%s: `%s` does nothing, since %s is a coroutine function; %s",
            place,
            text,
            name,
            _WAYS.get(name, _AWAIT) if text.startswith("async with ") else _AWAIT,
        )
    else:
        logger.error(
            "a call of %s did nothing, since it was not awaited; if it happens again, its line will be logged", name
        )


def forgotten_in(code: CodeType) -> str:
    """Return the line of a function that was reported as not awaited, as `file:line`; "" if there is none."""
    lines = {line for _, _, line in code.co_lines() if line is not None}
    return next((f"{code.co_filename}:{n}" for n in sorted(lines) if f"{code.co_filename}:{n}" in _reported), "")


def _origin(coroutine: Any, ended_in: FrameType | None) -> tuple[str, str]:
    """Return the place that created a coroutine, as `file:line`, and its source line; "" if unknown."""
    name = getattr(coroutine, "__name__", "")
    for file, line, _ in coroutine.cr_origin or ():
        if is_users(file):
            return f"{file}:{line}", _call_in(linecache.getline(file, line).strip(), name)
    # A coroutine that is not stored ends on the line that created it.
    frame = innermost(stack_from(ended_in))
    if frame is None:
        return "", ""
    text = linecache.getline(frame.f_code.co_filename, frame.f_lineno).strip()
    place = f"{frame.f_code.co_filename}:{frame.f_lineno}"
    return (place, _call_in(text, name)) if f"{name}(" in text else ("", "")


def _call_in(line: str, name: str) -> str:
    """Return the call of a function in a line; the line itself where it begins a block, or the call goes on below."""
    found = re.search(rf"[\w.]*\b{re.escape(name)}\(", line)
    if found is None or line.startswith("async with "):
        return line
    depth = 0
    for place in range(found.end() - 1, len(line)):
        depth += {"(": 1, ")": -1}.get(line[place], 0)
        if not depth:
            return line[found.start() : place + 1]
    return line
