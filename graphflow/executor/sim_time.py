"""Simulated time: a clock driven by /clock, for nodes whose `use_sim_time` is true.

The time is 0 until the first message. Then there are two counts. The time of day is the last value on /clock, even
after a jump back, as when a recording restarts. Sleeps and timers use the sum of all forward movements, so that a jump
back delays nothing and nothing is due twice. While /clock is silent, time stands still.

Source: the ROS 2 design article "Clock and Time".
"""

from __future__ import annotations

import heapq
import itertools
from asyncio import AbstractEventLoop
from collections.abc import Callable

from graphflow.executor.clock import Alarm, Clock


class _SimAlarm:
    def __init__(self, callback: Callable[[], None]) -> None:
        self._callback: Callable[[], None] | None = callback
        self.elsewhere: Alarm | None = None
        """The alarm that replaced it on another clock."""

    def run(self) -> None:
        callback, self._callback = self._callback, None
        if callback is not None:
            callback()

    def cancel(self) -> None:
        self._callback = None
        if self.elsewhere is not None:
            self.elsewhere.cancel()


class SimClock(Clock):
    """A clock that is set from outside."""

    def __init__(self, loop: AbstractEventLoop) -> None:
        self._loop = loop
        self._now_ns = 0
        self._elapsed_ns = 0
        self._alarms: list[tuple[int, int, _SimAlarm]] = []
        self._order = itertools.count()
        self._successor: Clock | None = None

    def time_ns(self) -> int:
        return self._now_ns if self._successor is None else self._successor.time_ns()

    def monotonic_ns(self) -> int:
        return self._elapsed_ns

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> _SimAlarm:
        alarm = _SimAlarm(callback)
        if self._successor is not None:
            self._move(when_ns, alarm, self._successor)
        elif when_ns <= self._elapsed_ns:
            self._loop.call_soon(alarm.run)
        else:
            heapq.heappush(self._alarms, (when_ns, next(self._order), alarm))
        return alarm

    def set_time(self, now_ns: int) -> None:
        """Set the time to `now_ns`. Alarms that become due run in the loop's next iteration."""
        if self._now_ns:  # the first message sets the start of time; it is not a jump
            self._elapsed_ns += max(0, now_ns - self._now_ns)
        self._now_ns = now_ns
        while self._alarms and self._alarms[0][0] <= self._elapsed_ns:
            self._loop.call_soon(heapq.heappop(self._alarms)[2].run)

    def retire(self, successor: Clock) -> None:
        """Stop following /clock: pending waits continue for the remaining time on another clock."""
        self._successor = successor
        while self._alarms:
            when_ns, _, alarm = heapq.heappop(self._alarms)
            self._move(when_ns, alarm, successor)

    def _move(self, when_ns: int, alarm: _SimAlarm, clock: Clock) -> None:
        rest = max(0, when_ns - self._elapsed_ns)
        alarm.elsewhere = clock.call_at(clock.monotonic_ns() + rest, alarm.run)
