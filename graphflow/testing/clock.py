"""A clock that a test advances manually."""

from __future__ import annotations

import asyncio
import heapq
import itertools
import time
from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

from graphflow.executor.clock import Clock
from graphflow.testing.forgotten import awaited
from graphflow.testing.outside import outside
from graphflow.times import to_ns

START_NS = 1_700_000_000_000_000_000
"""The time of day, in nanoseconds, at which every manual clock starts."""
OUTSIDE_LIMIT = 4.0
"""Seconds of real time that `settle` waits for threads and child processes; shorter than a test's idle limit."""
_TURNS = 100_000
_settling: WeakKeyDictionary[asyncio.AbstractEventLoop, int] = WeakKeyDictionary()


class _ManualAlarm:
    def __init__(self, callback: Callable[[], None]) -> None:
        self.callback: Callable[[], None] | None = callback

    def cancel(self) -> None:
        self.callback = None


class ManualClock(Clock):
    """A clock that stands still until `advance`."""

    def __init__(self) -> None:
        self._elapsed_ns = 0
        self._alarms: list[tuple[int, int, _ManualAlarm]] = []
        self._order = itertools.count()

    def time_ns(self) -> int:
        return START_NS + self._elapsed_ns

    def monotonic_ns(self) -> int:
        return self._elapsed_ns

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> _ManualAlarm:
        alarm = _ManualAlarm(callback)
        heapq.heappush(self._alarms, (when_ns, next(self._order), alarm))
        return alarm

    @awaited
    async def advance(self, seconds: float) -> None:
        """Let `seconds` pass: due work happens in order, each with all its consequences."""
        if seconds < 0:
            raise ValueError(f"time does not go back: advance({seconds!r})")
        until = self._elapsed_ns + to_ns(seconds)
        await settle()
        while self._alarms and self._alarms[0][0] <= until:
            when_ns, _, alarm = heapq.heappop(self._alarms)
            if alarm.callback is not None:
                self._elapsed_ns = max(self._elapsed_ns, when_ns)
                # Scheduled on the loop, since a handler must not run inside the test's own task.
                asyncio.get_running_loop().call_soon(alarm.callback)
                await settle()
        self._elapsed_ns = until
        await settle()


async def settle() -> None:
    """Wait until only the passage of time, or the world outside this process, could cause more work.

    This includes the threads, pools and child processes that the loop has started.

    Raises:
        RuntimeError: Some work never ends: a busy loop, a thread or a child process.
    """
    loop = asyncio.get_running_loop()
    work = outside(loop)
    until = time.monotonic() + OUTSIDE_LIMIT
    await _idle(loop)
    while work.is_awaited and (pending := sorted(set(work.pending()))):
        if time.monotonic() > until:
            raise RuntimeError(
                f"the graph does not settle: after {OUTSIDE_LIMIT:g} s it still waits for {', '.join(pending)}; "
                "replace it with a fake, or set graph.waits_outside = False"
            )
        await asyncio.sleep(0.001)
        await _idle(loop)


async def _idle(loop: asyncio.AbstractEventLoop) -> None:
    """Wait until the loop has no callbacks to run."""
    # asyncio has no public API for whether the loop is idle.
    ready: Any = getattr(loop, "_ready", ())
    _settling[loop] = _settling.get(loop, 0) + 1
    try:
        for _ in range(_TURNS):
            await asyncio.sleep(0)
            # Other calls of `settle` are always in the queue; waiting for them would never end.
            if len(ready) < _settling[loop]:
                return
    finally:
        _settling[loop] -= 1
    raise RuntimeError("the graph does not settle: a handler or task keeps waking itself without waiting")
