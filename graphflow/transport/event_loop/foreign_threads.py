"""Callbacks on threads that Python has not started: Zenoh's own.

CPython makes a thread state for each callback on such a thread, and frees it afterwards: 8 us, with two calls into the
system's memory. A thread that has asked for the GIL once and never given that back keeps its state, and a callback
costs 1 us. The state goes with the process, as Zenoh's threads do.

Source: PyGILState_Ensure in Python's C API, whose calls are counted.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from zenoh.handlers import Callback

THREADS_BOUND = 256
"""Threads whose states are kept; those after them pay for theirs, as without this module."""
_kept: set[int] = set()
"""The threads whose states are kept, and those that need no look any more."""


def _keep() -> None:
    """Keep the state of the thread that calls this."""
    if len(_kept) >= THREADS_BOUND:
        return
    _kept.add(threading.get_ident())
    try:
        import ctypes

        ctypes.pythonapi.PyGILState_Ensure()
    except (ImportError, AttributeError):  # a Python without ctypes, or one that is not CPython
        return


def at_once(put: Callable[[Any], None], drop: Callable[[], None] | None = None) -> Callback[Any]:
    """A callback that Zenoh calls where something arrives, without a queue and a thread of its own in between.

    Args:
        put: Must return at once: Zenoh's thread has other work.
        drop: Called when nothing more will come.
    """
    ident, kept = threading.get_ident, _kept

    def called(item: Any) -> None:
        if ident() not in kept:
            _keep()
        put(item)

    return Callback(called, drop=drop, indirect=False)
