"""Calls whose `await` a test has forgotten, such as `graph.clock.advance(1.0)`: nothing happens in them."""

from __future__ import annotations

import inspect
import linecache
import sys
from collections.abc import Callable, Coroutine
from functools import wraps
from typing import Any, NamedTuple, ParamSpec, TypeVar

from graphflow.errors import Place

P = ParamSpec("P")
T = TypeVar("T")


class _Call(NamedTuple):
    coroutine: Coroutine[Any, Any, Any]
    place: Place


_calls: list[_Call] = []
"""Those that had not begun when the last one was made."""


def awaited(method: Callable[P, Coroutine[Any, Any, T]]) -> Callable[P, Coroutine[Any, Any, T]]:
    """Remember the calls of a method of the fixture's until they begin."""

    @wraps(method)
    def call(*args: P.args, **kwargs: P.kwargs) -> Coroutine[Any, Any, T]:
        caller = sys._getframe(1)
        _calls[:] = filter(_has_not_begun, _calls)
        coroutine = method(*args, **kwargs)
        _calls.append(_Call(coroutine, Place(caller.f_code.co_filename, caller.f_lineno)))
        return coroutine

    return call


def forgotten() -> list[str]:
    """A sentence for each call that has not begun, with its line; they are given up."""
    calls = [*filter(_has_not_begun, _calls)]
    _calls.clear()
    for call in calls:
        call.coroutine.close()  # or Python complains of it as well
    return [f"{call.place}: this does nothing until it is awaited; write {_written(call)}" for call in calls]


def _has_not_begun(call: _Call) -> bool:
    return inspect.getcoroutinestate(call.coroutine) == inspect.CORO_CREATED


def _written(call: _Call) -> str:
    """The line with its `await`, as far as it is no more than the call."""
    line = linecache.getline(call.place.file, call.place.line).partition("  #")[0].strip()
    name = getattr(call.coroutine, "__name__", "")
    is_whole = line.endswith(")") and line.partition("(")[0].endswith(f".{name}")
    return f"await {line}" if is_whole and "=" not in line.partition("(")[0] else f"await graph...{name}(...)"
