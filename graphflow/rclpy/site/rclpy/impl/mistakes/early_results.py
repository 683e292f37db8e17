"""Results that are asked for in the line that sends the request: `client.call_async(request).result()`.

They are None, again and again; ROS 2 says nothing of it.
"""

from __future__ import annotations

import logging
from types import CodeType

from rclpy.impl.callers import Caller

_seen: set[tuple[CodeType, int]] = set()
"""The calls that have been looked at."""
SEEN_BOUND = 1000
"""Calls that are remembered; further ones, as of a program that compiles code again and again, are not looked at."""
logger = logging.getLogger("graphflow")


def check(asked: Caller | None) -> None:
    """Tell if code has asked a call for the result of a future that it has just made, once for each line.

    Args:
        asked: The code that asks a future that is not done.
    """
    if asked is None or len(_seen) >= SEEN_BOUND or (call := (asked.frame.f_code, asked.frame.f_lasti)) in _seen:
        return
    _seen.add(call)
    if asked.is_chained:
        text = "%s: future.result() is None until the future is done: future.add_done_callback(...), or await it"
        logger.warning(text, asked.place)
