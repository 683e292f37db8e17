"""Errors in a node's handlers: rate-limited logging, and the budget after which they end the node."""

from __future__ import annotations

import concurrent.futures
import logging
from asyncio import CancelledError
from collections import deque
from collections.abc import Callable
from pathlib import PurePath
from typing import NamedTuple

from graphflow.analysis.user_code import place_in, users_part
from graphflow.errors import DeadlockError, GraphflowError, TooManyErrors
from graphflow.interface import OnError
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.mistakes.errors.python_errors import remark_on
from graphflow.runtime.part import Host
from graphflow.runtime.stop_limit import Interrupted
from graphflow.times import NANOSECONDS, to_ns


class ErrorBudget(NamedTuple):
    """The number of errors tolerated per period (seconds); one more ends the node."""

    errors: int
    per: float


def report(log: logging.Logger, label: str, error: BaseException) -> None:
    """Log an error: graphflow's own as a sentence, any other with its traceback."""
    if isinstance(error, Interrupted):  # the program was asked to end
        return
    explain(error)
    if isinstance(error, (SystemExit, KeyboardInterrupt)):
        text = "%s: ends the process by %s (%s); self.shutdown() ends the node, and the process with its last node"
        log.warning(text, label, type(error).__name__, place_in(error))
    elif isinstance(error, DeadlockError):
        log.error("%s", _with_line(label, error))
    elif isinstance(error, GraphflowError):
        place = place_in(error)
        log.error("%s: %s%s", label, error, place and f" ({place})")
    elif not place_in(error):  # raised about user code, not within it
        log.error("%s: %s: %s", label, type(error).__name__, error)
    else:
        log_with_traceback(log, f"{label}: ", error)


def log_with_traceback(log: logging.Logger, prefix: str, error: BaseException) -> None:
    """Log an error with advice, where there is some, and the user's part of its traceback."""
    explain(error)
    remark, trace = remark_on(error), (type(error), error, users_part(error))
    text = "; ".join(filter(None, [str(error), remark]))
    log.error("%s%s: %s", prefix, type(error).__name__, text, exc_info=trace)


def _with_line(label: str, error: DeadlockError) -> str:
    """Return the text of a deadlock error with the line of this handler, which only propagates the error."""
    head, newline, rest = str(error).partition("\n")
    place = PurePath(place_in(error)).name
    return f"{head}; {label} waited in {place}{newline}{rest}" if place and f"{place} " not in rest else str(error)


class Failures:
    """The error policy of one node.

    Args:
        budget: The errors tolerated; None for any number.
        end: Called with the error that ends the node.
    """

    def __init__(self, host: Host, budget: ErrorBudget | None, end: Callable[[BaseException], None]) -> None:
        self._host, self._budget, self._end = host, budget, end
        self._counted: deque[int] = deque()
        self._silence: dict[tuple[str, str, str], tuple[int, int]] = {}
        """For each (handler, error type, line): the end of its silence in nanoseconds, and the records suppressed."""

    def failed(self, label: str, error: BaseException, on_error: OnError | None) -> None:
        """Handle an error that a handler raised; with None for the policy, it is only reported."""
        if isinstance(error, (CancelledError, concurrent.futures.CancelledError)):  # of a coroutine, or of a thread
            return
        if on_error is None or not self._host.is_running:  # the run outlived the stop
            self._host.report_error(label, error)
            return
        now = self._host.context.clock.monotonic_ns()
        self._log(label, error, now)
        if on_error == "end":
            self._end(error)
        elif on_error == "budget" and self._budget is not None:
            self._count(label, error, now, self._budget)

    def _log(self, label: str, error: BaseException, now: int) -> None:
        """Log the first error of a kind and line in a handler, and then at most one a second."""
        key = (label, type(error).__name__, place_in(error))
        until, unsaid = self._silence.get(key, (0, 0))
        if now < until:
            self._silence[key] = until, unsaid + 1
            return
        self._silence[key] = now + NANOSECONDS, 0
        self._host.report_error(f"{label} ({unsaid} more before this)" if unsaid else label, error)

    def _count(self, label: str, error: BaseException, now: int, budget: ErrorBudget) -> None:
        self._counted.append(now)
        while self._counted[0] <= now - to_ns(budget.per):
            self._counted.popleft()
        if len(self._counted) > budget.errors:
            self._counted.clear()
            head = str(error).partition("\n")[0]
            # What no message has set is None still; the check of names comes later than this.
            unheard = self._host.context.unmatched.unheard(self._host.full_name) if "NoneType" in head else ""
            text = (
                f"{budget.errors + 1} handler errors within {budget.per:g} s, the last in {label}: "
                f"{type(error).__name__}: {head}{f'; {unheard}' if unheard else '.'} The node ends; "
                "on_error='log' keeps a handler out of the count, and the class's error_budget sets the limit"
            )
            self._end(TooManyErrors(text))
