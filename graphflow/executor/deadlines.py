"""Deadlines of many calls with a single alarm: one alarm each would take a tenth of a call's time."""

from __future__ import annotations

from asyncio import Future
from collections.abc import Callable
from typing import Any

from graphflow.executor.clock import Alarm, Clock


class Deadlines:
    """Deadlines of futures. No alarm is set while there are none.

    Args:
        clock: The clock of the deadlines.
    """

    __slots__ = ("_alarm", "_alarm_ns", "_due", "clock")

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self._due: dict[Future[Any], tuple[int, Callable[[], Exception]]] = {}
        self._alarm: Alarm | None = None
        self._alarm_ns = 0

    def add(self, future: Future[Any], deadline_ns: int, error: Callable[[], Exception]) -> None:
        """Fail a future with `error()` once the clock has reached `deadline_ns`."""
        self._due[future] = (deadline_ns, error)
        if self._alarm is None or deadline_ns < self._alarm_ns:
            self._set(deadline_ns)

    def discard(self, future: Future[Any]) -> None:
        """Remove a future, which may have ended."""
        self._due.pop(future, None)
        if not self._due and self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def _set(self, when_ns: int) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
        self._alarm_ns, self._alarm = when_ns, self.clock.call_at(when_ns, self._ring)

    def _ring(self) -> None:
        self._alarm = None
        now = max(self._alarm_ns, self.clock.monotonic_ns())  # a loop may call a little early
        for future, (deadline_ns, error) in sorted(self._due.items(), key=lambda item: item[1][0]):
            if deadline_ns > now:
                break
            del self._due[future]
            if not future.done():
                future.set_exception(error())
        if self._due:
            self._set(min(deadline_ns for deadline_ns, _ in self._due.values()))
