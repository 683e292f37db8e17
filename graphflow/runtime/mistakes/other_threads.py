"""Calls from other threads to a node: `call_soon`, and warnings of calls that are not thread-safe."""

from __future__ import annotations

import asyncio
import inspect
import linecache
import logging
import re
import sys
import threading
from collections.abc import Callable
from pathlib import PurePath
from types import FrameType

from graphflow.analysis.user_code import is_users
from graphflow.errors import ClosedError, Place
from graphflow.runtime.callables import name_of
from graphflow.runtime.part import Host

PLACES_BOUND = 100
"""Lines of code remembered, so that each is reported once."""
_ASYNCIO = str(PurePath(asyncio.__file__).parent)
_CALL = re.compile(r"([\w.]+\.(?:put_nowait|get_nowait|set|set_result|set_exception|cancel|notify|release))\((.*)")
_STARTS = re.compile(r"\b(create_task|ensure_future)\(")
logger = logging.getLogger("graphflow")


def call_soon(host: Host, fn: Callable[..., object], args: tuple[object, ...]) -> None:
    """Call `fn(*args)` on a node's event loop, from any thread. An error in it is logged.

    Raises:
        ClosedError: The node is not running.
        TypeError: `fn` is a coroutine function.
    """
    name = name_of(fn)
    if inspect.iscoroutinefunction(fn):
        raise TypeError(f"call_soon calls functions; {name} is a coroutine function: spawn({name}) runs it")

    def call() -> None:
        try:
            fn(*args)
        except Exception as error:  # raised by the user's function: no caller could receive it
            host.report_error(f"call_soon of {name}", error)

    try:
        host.context.loop.call_soon_threadsafe(call)
    except RuntimeError:
        raise ClosedError(f"call_soon of {name}: the event loop of node {host.full_name} has ended") from None


def report_foreign_calls(loop: asyncio.AbstractEventLoop) -> None:
    """Report asyncio calls that another thread makes, such as `queue.put_nowait` and `future.set_result`."""
    if hasattr(loop, "stranger"):
        reported = set[Place]()
        loop.stranger = lambda: _report(reported, sys._getframe(2))


def _report(reported: set[Place], frame: FrameType | None) -> None:
    """Report a call if user code made it.

    Args:
        frame: The caller of the loop's method.
    """
    # The collector may run a `__del__` of asyncio's in any thread: the line that it interrupts is innocent.
    while frame is not None and frame.f_code.co_filename.startswith(_ASYNCIO) and frame.f_code.co_name != "__del__":
        frame = frame.f_back
    if frame is None or not is_users(frame.f_code.co_filename):
        return
    place = Place(frame.f_code.co_filename, frame.f_lineno)
    if place in reported or len(reported) >= PLACES_BOUND:
        return
    reported.add(place)
    text = (
        "%s: thread %r changes the event loop's state, which takes effect only when something else wakes the loop, "
        "perhaps seconds later; write %s"
    )
    logger.error(text, place, threading.current_thread().name, _correction(linecache.getline(place.file, place.line)))


def _correction(line: str) -> str:
    """Return the correct form of a line."""
    if _STARTS.search(line):
        return "self.spawn(fn, ...)"
    found = _CALL.search(line)
    if found is None:
        return "self.call_soon(fn, ...)"
    return f"self.call_soon({found[1]}{'' if found[2].startswith(')') else ', ...'})"
