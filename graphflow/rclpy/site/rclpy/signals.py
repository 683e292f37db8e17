"""What SIGINT and SIGTERM do while rclpy is in use: they end its contexts, and then what they did before."""

from __future__ import annotations

import signal
import threading
from types import FrameType
from typing import Any
from weakref import WeakSet

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
_NUMBERS = {
    SignalHandlerOptions.NO: (),
    SignalHandlerOptions.SIGINT: (signal.SIGINT,),
    SignalHandlerOptions.SIGTERM: (signal.SIGTERM,),
    SignalHandlerOptions.ALL: (signal.SIGINT, signal.SIGTERM),
}


def watch(context: Context) -> None:
    """End a context when a signal comes."""
    _watched.add(context)


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Handle these signals. Outside the main thread, where Python has none, nothing is done."""
    global _options
    if threading.current_thread() is not threading.main_thread():
        return
    for number in _NUMBERS[options]:
        if number not in _former:
            _former[number] = signal.signal(number, _caught)
    _options = options


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """The signals that are handled now."""
    return _options


def uninstall_signal_handlers() -> None:
    """Handle signals no more."""
    global _options
    _options = SignalHandlerOptions.NO
    if threading.current_thread() is not threading.main_thread():
        return
    for number, handler in list(_former.items()):
        if signal.getsignal(number) is _caught:
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)
        del _former[number]


def _caught(number: int, frame: FrameType | None) -> None:
    for context in list(_watched):
        life = context.life
        if life is not None and life.end():
            # What it calls may take long, or wait for what this thread holds.
            threading.Thread(target=context.finish, name="graphflow-shutdown", daemon=True).start()
    former = _former.get(number)
    is_ending = not threading.main_thread().is_alive()  # the interpreter waits only for the network to be left
    if callable(former) and not is_ending:
        former(number, frame)
