"""Orderly shutdown: signals that stop nodes, and the reasons why a process does not end."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from types import FunctionType, MethodType

from graphflow.analysis.frames import stack_of
from graphflow.analysis.user_code import called_by_loop, innermost

logger = logging.getLogger("graphflow")

SAME_SIGNAL = 0.1
"""Seconds within which a second signal counts as the first."""
REMIND_AFTER = 1.0
"""Seconds after a signal at which a program that is still stopping reports what it waits for."""
CHECK_AFTER, CHECK_EVERY = 1.0, 60.0
"""Seconds until the signal handlers are first checked, and the longest time between two checks.
The interval doubles with each check, as libraries replace signal handlers when they are first used."""
_MANAGER = "_ExecutorManagerThread"
"""The class of the thread that keeps the interpreter alive until a `ProcessPoolExecutor` has finished."""


class StopRequest(asyncio.Event):
    """An event that stops a program.

    A task that waits for the event resumes only some iterations of the loop later, and due timers run in each of them.
    `when_set` is called synchronously.
    """

    def __init__(self) -> None:
        super().__init__()
        self.when_set: Callable[[], object] | None = None

    def set(self) -> None:
        is_first = not self.is_set()
        super().set()
        if is_first and self.when_set is not None:
            self.when_set()


def catch_signals(stop: asyncio.Event) -> Callable[[], None]:
    """Set `stop` on SIGINT, SIGTERM or SIGHUP; a second signal ends the process at once, even if the loop is blocked.

    Signals within `SAME_SIGNAL` count as one: a shell may signal a process and then its group. A library that replaces
    a handler prevents an orderly shutdown; a warning names it.

    Returns:
        A function that restores the former handlers.
    """
    loop = asyncio.get_running_loop()
    first = 0.0
    reminder = threading.Timer(REMIND_AFTER, _remind)
    reminder.daemon = True

    own = os.getpid()

    def caught(number: int, _: object) -> None:
        nonlocal first
        if os.getpid() != own:  # a forked child, such as a process pool's, inherits the handler
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        now, is_first = time.monotonic(), not first
        first = first or now
        if now - first > SAME_SIGNAL:
            # By a system call: this may have interrupted `logging` or `print`, which cannot be entered again.
            os.write(2, b"ended without cleanup: it was asked twice\n")
            os._exit(1)
        if not loop.is_closed():
            loop.call_soon_threadsafe(stop.set)
        if is_first and not reminder.finished.is_set():  # a second signal may arrive while the thread is starting
            reminder.start()

    # Not loop.add_signal_handler: its callbacks would wait for a handler that blocks the loop.
    former = {number: signal.signal(number, caught) for number in _stop_signals()}
    watch = loop.call_later(CHECK_AFTER, lambda: check(CHECK_AFTER))

    def check(waited: float) -> None:
        nonlocal watch
        others = {number: found for number in former if (found := signal.getsignal(number)) is not caught}
        _warn_of_replaced(others)
        if not others:
            wait = min(2 * waited, CHECK_EVERY)
            watch = loop.call_later(wait, check, wait)

    def restore() -> None:
        watch.cancel()
        reminder.cancel()
        for number, handler in former.items():
            signal.signal(number, handler)

    return restore


def _warn_of_replaced(others: Mapping[signal.Signals, object]) -> None:
    for number, handler in others.items():
        logger.warning(
            "%s has replaced the handler of %s: unless it calls the previous handler, that signal no longer "
            "stops the nodes, and their on_shutdown will not run",
            _name(handler),
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
    return f"code that chose {handler}"


def _remind() -> None:
    reasons = [*hindrances()]
    waits = f" (waiting for {'; '.join(reasons)})" if reasons else ""
    os.write(2, f"still stopping{waits}; Ctrl-C again ends it without cleanup\n".encode())


def hindrances() -> Iterator[str]:
    """List the reasons why this process does not end: lines of user code, by thread, and work in process pools."""
    for thread in threading.enumerate():
        if thread.daemon or thread.ident is None:
            continue
        if type(thread).__name__ == _MANAGER:
            import multiprocessing  # already imported by that thread's pool

            workers = ", ".join(str(child.pid) for child in multiprocessing.active_children())
            yield f"the work of a process pool, processes {workers}"
        elif (frame := innermost(called_by_loop(stack_of(thread.ident)))) is not None:
            yield f"{frame.f_code.co_filename}:{frame.f_lineno} in {frame.f_code.co_name}, thread {thread.name!r}"
