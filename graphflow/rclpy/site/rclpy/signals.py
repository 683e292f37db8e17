"""Handlers for SIGINT and SIGTERM while rclpy is in use: they shut contexts down, then do what they did before."""

from __future__ import annotations

import _thread
import logging
import signal
import threading
import time
from types import FrameType
from typing import Any
from weakref import WeakSet

from graphflow.rclpy.hints import swallowed_interrupts, tracebacks
from rclpy._rclpy_pybind11 import SignalHandlerOptions
from rclpy.context import Context

__all__ = [
    "SignalHandlerOptions",
    "get_current_signal_handlers_options",
    "install_signal_handlers",
    "uninstall_signal_handlers",
]

_watched: WeakSet[Context] = WeakSet()
_former: dict[int, Any] = {}
_options = SignalHandlerOptions.NO
PUT_OFF = 0.002
"""Seconds by which a signal that interrupts logging is postponed."""
PUT_OFF_BOUND = 50
"""The number of postponements, at most: logging itself may block."""
_put_off: dict[int, int] = {}
_NUMBERS = {
    SignalHandlerOptions.NO: (),
    SignalHandlerOptions.SIGINT: (signal.SIGINT,),
    SignalHandlerOptions.SIGTERM: (signal.SIGTERM,),
    SignalHandlerOptions.ALL: (signal.SIGINT, signal.SIGTERM),
}


def watch(context: Context) -> None:
    """End a context when a signal arrives."""
    _watched.add(context)


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Install handlers for signals. Outside the main thread, where Python allows none, do nothing."""
    global _options
    if threading.current_thread() is not threading.main_thread():
        return
    for number in _NUMBERS[options]:
        if number not in _former:
            _former[number] = signal.signal(number, _caught)
    _options = options


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return the signals that are handled now."""
    return _options


def uninstall_signal_handlers() -> None:
    """Restore the former handlers."""
    global _options
    _options = SignalHandlerOptions.NO
    if threading.current_thread() is not threading.main_thread():
        return
    for number, handler in list(_former.items()):
        if signal.getsignal(number) is _caught:
            # None stands for a handler that was not installed from Python, which Python cannot restore.
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)
        del _former[number]


def _is_in_logging(frame: FrameType) -> bool:
    """Whether Python's logging was interrupted. An exception there would leave a lock held that other threads need."""
    seen: FrameType | None = frame
    while seen is not None:
        if seen.f_code.co_filename == logging.__file__:
            return True
        seen = seen.f_back
    return False


def _again(number: int) -> None:
    time.sleep(PUT_OFF)
    main = threading.main_thread().ident
    if hasattr(signal, "pthread_kill") and main is not None:
        signal.pthread_kill(main, number)  # which ends a wait as well
    else:
        _thread.interrupt_main(signal.Signals(number))


def _caught(number: int, frame: FrameType | None) -> None:
    if frame is not None and _is_in_logging(frame) and _put_off.get(number, 0) < PUT_OFF_BOUND:
        _put_off[number] = _put_off.get(number, 0) + 1
        _thread.start_new_thread(_again, (number,))
        return
    _put_off.pop(number, None)
    swallowed_interrupts.end_if_stuck(frame)
    is_ending = not threading.main_thread().is_alive()  # the interpreter waits only for other threads to end
    ended = [context for context in list(_watched) if context.life is not None and context.life.interrupt()]
    if ended and not is_ending:
        swallowed_interrupts.watch()
    for context in ended:
        if is_ending:  # there can be no new thread, and this one holds nothing
            context.finish()
        else:
            # The callbacks may take long, or wait for a lock that this thread holds; even `Thread.start` may.
            _thread.start_new_thread(context.finish, ())
    former = _former.get(number)
    if callable(former) and not is_ending:
        tracebacks.install()
        former(number, frame)
