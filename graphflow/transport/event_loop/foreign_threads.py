"""Callbacks on threads that Python has not started, such as Zenoh's.

For each callback on such a thread, CPython creates a thread state and frees it afterwards: 8 us, with two system calls
for memory. A thread with an unmatched PyGILState_Ensure keeps its state, and a callback costs 1 us. The state lasts
until the process ends, as Zenoh's threads do.

Source: PyGILState_Ensure in Python's C API, whose calls are counted.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from zenoh.handlers import Callback

THREADS_BOUND = 256
"""Threads whose states are kept; further ones pay the full cost."""
_kept: set[int] = set()
"""Threads whose states are kept, and those that need no further check."""


def _keep() -> None:
    """Keep the state of the calling thread."""
    if len(_kept) >= THREADS_BOUND:
        return
    _kept.add(threading.get_ident())
    try:
        import ctypes

        ctypes.pythonapi.PyGILState_Ensure()
    except (ImportError, AttributeError):  # a Python without ctypes, or not CPython
        return


def at_once(put: Callable[[Any], None], drop: Callable[[], None] | None = None) -> Callback[Any]:
    """Return a callback that Zenoh calls on the arriving thread, without a queue and a thread in between.

    Args:
        put: Receives each arrival; must not block, since Zenoh's thread has other work.
        drop: Called after the last arrival.
    """
    ident, kept = threading.get_ident, _kept

    def called(item: Any) -> None:
        if ident() not in kept:
            _keep()
        put(item)

    return Callback(called, drop=drop, indirect=False)
