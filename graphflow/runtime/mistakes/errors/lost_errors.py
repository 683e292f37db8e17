"""Errors that nobody awaits, of `asyncio.create_task` or `call_later`: logged as errors of handlers are.

Those of tasks that are kept are found by `kept_errors`.
"""

from __future__ import annotations

import asyncio
import logging
from collections import Counter

from graphflow.analysis.user_code import place_in
from graphflow.errors import ClosedError
from graphflow.runtime.failures import report
from graphflow.runtime.mistakes.errors.attribute_errors import explain

PLACES_BOUND = 1000
"""Distinct errors counted, by type and line."""
logger = logging.getLogger("graphflow")


def log_lost_errors(loop: asyncio.AbstractEventLoop) -> None:
    """Log errors lost on a loop, unless the program has set its own exception handler."""
    if loop.get_exception_handler() is None:
        loop.set_exception_handler(_LostErrors())


class _LostErrors:
    """An event loop's exception handler that logs an error the first, tenth and hundredth time."""

    def __init__(self) -> None:
        self._times: Counter[tuple[str, str]] = Counter()

    def __call__(self, loop: asyncio.AbstractEventLoop, context: dict[str, object]) -> None:
        error, future = context.get("exception"), context.get("future") or context.get("task")
        if isinstance(error, BaseException):
            explain(error)
        is_lost = future is not None and "never retrieved" in str(context.get("message"))
        if not isinstance(error, BaseException) or not (is_lost or "handle" in context):
            loop.default_exception_handler(context)
            return
        # Its node has stopped in the meantime, or somebody has cancelled it on purpose.
        if isinstance(error, (ClosedError, asyncio.CancelledError)):
            logger.debug("lost: %s", error)
            return
        coroutine = future.get_coro() if isinstance(future, asyncio.Task) else None
        name = getattr(coroutine, "__qualname__", "") or ("a future" if is_lost else "a callback of the event loop")
        key = name, f"{type(error).__name__} {place_in(error)}"
        if len(self._times) >= PLACES_BOUND:
            self._times.clear()
        self._times[key] += 1
        times = self._times[key]
        if str(times).strip("0") == "1":  # 1, 10, 100 and so on
            again = f", {times} times by now" if times > 1 else ""
            way = "await it, or start it with self.spawn(...), which ends the node on an error"
            what = f"failed, and nothing awaits it{again} ({way})" if is_lost else f"failed{again}"
            report(logger, f"{name} {what}", error)
