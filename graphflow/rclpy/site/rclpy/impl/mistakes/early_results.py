"""Results that are read in the line that sends the request: `client.call_async(request).result()`.

They are always None; ROS 2 does not report it.
"""

from __future__ import annotations

import logging
from types import CodeType

from rclpy.impl.callers import Caller

_seen: set[tuple[CodeType, int]] = set()
"""The calls that have been checked."""
SEEN_BOUND = 1000
"""The number of calls to remember; further ones, as of a program that keeps compiling code, are not checked."""
logger = logging.getLogger("graphflow")


def check(asked: Caller | None) -> None:
    """Warn, once per line, if code reads the result of a future that its own call has just created.

    Args:
        asked: The code that reads the result of a pending future.
    """
    if asked is None or len(_seen) >= SEEN_BOUND or (call := (asked.frame.f_code, asked.frame.f_lasti)) in _seen:
        return
    _seen.add(call)
    if asked.is_chained:
        text = "%s: future.result() is None until the future is done: future.add_done_callback(...), or await it"
        logger.warning(text, asked.place)
