"""Orderly shutdown: the signals that stop nodes."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from types import FrameType, FunctionType, MethodType
from typing import Any, TypeAlias

from graphflow.runtime.stop_limit import StopLimit, is_exiting, place_of, say

logger = logging.getLogger("graphflow")

_Handler: TypeAlias = Callable[[int, FrameType | None], Any] | int | None
"""A signal handler, as `signal.signal` takes and returns it."""

SAME_SIGNAL = 0.1
"""Seconds within which a second signal counts as the first."""
CHECK_AFTER, CHECK_EVERY = 1.0, 60.0
"""Seconds until the signal handlers are first checked, and the longest time between two checks.
The interval doubles with each check, as libraries replace signal handlers when they are first used."""


class StopRequest(asyncio.Event):
    """An event that stops a program.

    A task that waits for the event resumes only some iterations of the loop later, and due timers run in each of them.
    `when_set` is called synchronously.
    """

    def __init__(self) -> None:
        super().__init__()
        self.when_set: Callable[[], object] | None = None
        self.node_stopped: Callable[[], object] = int
        """Called for each node that has stopped."""

    def set(self) -> None:
        is_first = not self.is_set()
        super().set()
        if is_first and self.when_set is not None:
            self.when_set()


def catch_signals(stop: asyncio.Event, *, is_limited: bool = False) -> Callable[[], None]:
    """Set `stop` on SIGINT, SIGTERM or SIGHUP; a second signal ends the process at once, even if the loop is blocked.

    Signals within `SAME_SIGNAL` count as one: a shell may signal a process and then its group. A library that replaces
    a handler prevents an orderly shutdown; a warning names it.

    Args:
        is_limited: Whether a process that does not end is ended, as `stop_limit` decides. The supervisor ends its own.

    Returns:
        A function that restores the former handlers, once all nodes have stopped.
    """
    loop = asyncio.get_running_loop()
    first = 0.0
    limit = StopLimit(loop, is_enforced=is_limited)
    if isinstance(stop, StopRequest):
        stop.node_stopped = limit.changed
    own = os.getpid()

    def caught(number: int, frame: FrameType | None) -> None:
        nonlocal first
        if os.getpid() != own:  # a forked child, such as a process pool's, inherits the handler
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        if limit.interrupts:
            limit.interrupt(frame)
            return
        now = time.monotonic()
        first = first or now
        if now - first > SAME_SIGNAL:
            say(f"ended without cleanup: it was asked twice{_busy()}")
            os._exit(1)
        _begin_to_end(loop, stop, limit, number)

    # Not loop.add_signal_handler: its callbacks would wait for a handler that blocks the loop.
    former = {number: signal.signal(number, caught) for number in _stop_signals()}
    watch = loop.call_later(CHECK_AFTER, lambda: check(CHECK_AFTER))

    def check(waited: float) -> None:
        nonlocal watch
        others = {number: found for number in former if (found := signal.getsignal(number)) is not caught}
        _warn_of_replaced(loop, others)
        if not others:
            wait = min(2 * waited, CHECK_EVERY)
            watch = loop.call_later(wait, check, wait)

    def restore() -> None:
        watch.cancel()
        limit.closed()
        for number, handler in former.items():
            signal.signal(number, _ending_twice(handler) if is_limited and limit.is_started else handler)

    return restore


def _busy() -> str:
    """Return where the main thread is in the user's code, as the end of a line; "" if it is not in any."""
    return "".join(f"; it was in {place}" for place in place_of(threading.get_ident()))


def _ending_twice(former: _Handler) -> _Handler:
    """Return a handler that ends a process that waits for its threads, as its reminder says, or calls a former one."""

    def caught(number: int, frame: FrameType | None) -> None:
        if is_exiting() or not callable(former):
            say("ended without cleanup: it was asked twice")
            os._exit(1)
        former(number, frame)

    return former if former is signal.SIG_IGN else caught


def _begin_to_end(loop: asyncio.AbstractEventLoop, stop: asyncio.Event, limit: StopLimit, number: int) -> None:
    if not loop.is_closed():
        loop.call_soon_threadsafe(stop.set)
    if not limit.is_started:  # a second signal may arrive while the thread is starting
        limit.start(number)


def _warn_of_replaced(loop: asyncio.AbstractEventLoop, others: Mapping[signal.Signals, object]) -> None:
    # asyncio has no public API for the callbacks of signals, and uvloop none at all.
    callbacks: Mapping[int, Any] = vars(loop).get("_signal_handlers", {})
    for number, handler in others.items():
        if number in callbacks:
            who = f"loop.add_signal_handler, which calls {callbacks[number]},"
        elif "__sighandler" in repr(handler):
            who = "loop.add_signal_handler"
        else:
            who = _name(handler)
        logger.warning(
            "%s has replaced the handler of %s: unless it calls the previous handler, that signal no longer "
            "stops the nodes, and their on_shutdown will not run",
            who,
            number.name,
        )


def _stop_signals() -> Iterator[signal.Signals]:
    yield signal.SIGINT
    yield signal.SIGTERM
    # Sent when the terminal closes; nohup makes a process ignore it.
    if sys.platform != "win32" and signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        yield signal.SIGHUP


def _name(handler: object) -> str:
    """Return a signal handler's function and its place, as far as they are known."""
    function = handler.__func__ if isinstance(handler, MethodType) else handler
    if isinstance(function, FunctionType):
        code = function.__code__
        return f"{function.__module__}.{function.__qualname__} ({code.co_filename}:{code.co_firstlineno})"
    if handler is None:
        return "code outside Python"
    return f"code that chose {handler.name}" if isinstance(handler, signal.Handlers) else repr(handler)
