"""Requests of other threads to a node: to call something on its event loop."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from graphflow.errors import ClosedError
from graphflow.runtime.host import Host


def call_soon(host: Host, fn: Callable[..., object], args: tuple[Any, ...]) -> None:
    """Call `fn(*args)` on the event loop of a node, from any thread. An error in it is logged.

    Raises:
        ClosedError: The node does not run.
        TypeError: `fn` is a coroutine function.
    """
    name = getattr(fn, "__name__", str(fn))
    if inspect.iscoroutinefunction(fn):
        raise TypeError(f"call_soon calls functions; {name} is a coroutine function: spawn({name}) runs it")

    def call() -> None:
        try:
            fn(*args)
        except Exception as error:
            host.report_error(f"call_soon of {name}", error)

    try:
        host.context.loop.call_soon_threadsafe(call)
    except RuntimeError:
        raise ClosedError(f"call_soon of {name}: the event loop of node {host.full_name} has ended") from None
