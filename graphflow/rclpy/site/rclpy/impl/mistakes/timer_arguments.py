"""Callbacks of timers with an argument: ROS 2 calls them without one, unless it is annotated `TimerInfo`."""

from __future__ import annotations

import inspect
import logging
from collections.abc import Callable
from types import CodeType

from graphflow.analysis.user_code import is_users, short_place
from graphflow.runtime.callables import code_of

logger = logging.getLogger("graphflow")
_told = set[CodeType]()
"""The callbacks that have been told."""


def warn_of_argument(callback: Callable[..., object]) -> None:
    """Warn of a callback whose argument ROS 2 would not fill; once, however many timers call it."""
    given = [p for p in inspect.signature(callback).parameters.values() if p.default is p.empty]
    code = code_of(inspect.unwrap(callback))
    if code is None or not is_users(code.co_filename) or not given or "TimerInfo" in str(given[0].annotation):
        return
    if code in _told:
        return
    _told.add(code)
    name, place = given[0].name, short_place(code.co_filename, code.co_firstlineno)
    text = "%s: in ROS 2 a timer calls %s without arguments: leave out %s, or write %s: TimerInfo"
    logger.warning(text, place, code.co_name, name, name)
