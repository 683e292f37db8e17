"""Calls without their `await` in tests, such as `graph.clock.advance(1.0)`, which have no effect."""

from __future__ import annotations

import inspect
import linecache
import re
import sys
from collections.abc import Callable, Coroutine
from functools import wraps
from typing import NamedTuple, ParamSpec, TypeVar

from graphflow.errors import Place

P = ParamSpec("P")
T = TypeVar("T")


class _Call(NamedTuple):
    coroutine: Coroutine[object, object, object]
    place: Place


_calls: list[_Call] = []
"""Calls that had not started when the last one was made."""


def awaited(method: Callable[P, Coroutine[object, object, T]]) -> Callable[P, Coroutine[object, object, T]]:
    """Track the calls of a method of the fixture until they start."""

    @wraps(method)
    def call(*args: P.args, **kwargs: P.kwargs) -> Coroutine[object, object, T]:
        caller = sys._getframe(1)
        _calls[:] = filter(_has_not_begun, _calls)
        coroutine = method(*args, **kwargs)
        _calls.append(_Call(coroutine, Place(caller.f_code.co_filename, caller.f_lineno)))
        return coroutine

    return call


def forgotten() -> list[str]:
    """Return a sentence with its line for each call that has not started, and discard them."""
    calls = [*filter(_has_not_begun, _calls)]
    _calls.clear()
    for call in calls:
        call.coroutine.close()  # or Python warns that it was never awaited, too
    return [f"{call.place}: this has no effect until it is awaited; write {_written(call)}" for call in calls]


def _has_not_begun(call: _Call) -> bool:
    return inspect.getcoroutinestate(call.coroutine) == inspect.CORO_CREATED


def _written(call: _Call) -> str:
    """Return the line with its `await` if it consists of the call only, or else the call."""
    line = linecache.getline(call.place.file, call.place.line).partition("  #")[0].strip()
    name = getattr(call.coroutine, "__name__", "")
    is_whole = line.endswith(")") and line.partition("(")[0].endswith(f".{name}")
    if is_whole and "=" not in line.partition("(")[0]:
        return f"await {line}"
    found = re.search(rf"[\w.]+\.{name}\(", line)
    return f"await {found[0] if found else f'graph...{name}('}...)"
