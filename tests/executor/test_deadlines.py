"""Deadlines of many calls by one alarm."""

from __future__ import annotations

import asyncio
from asyncio import Future
from collections.abc import Callable
from typing import Any

from graphflow.executor.deadlines import Deadlines
from graphflow.testing.clock import ManualClock


class CountingClock(ManualClock):
    """Counts the alarms that are set, and that have not been cancelled."""

    set = 0

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> Any:
        self.set += 1
        return super().call_at(when_ns, callback)

    @property
    def pending(self) -> int:
        return sum(alarm.callback is not None for _, _, alarm in self._alarms)


def error() -> Exception:
    return TimeoutError("late")


async def test_each_ends_at_its_own_time(graphflow_runner: asyncio.Runner) -> None:
    """In any order of addition; done and discarded futures are left alone."""
    clock = CountingClock()
    deadlines = Deadlines(clock)
    futures: dict[int, Future[None]] = {s: asyncio.get_running_loop().create_future() for s in (3, 1, 2, 4, 5)}
    for seconds, future in futures.items():
        deadlines.add(future, seconds * 10**9, error)
    assert (clock.set, clock.pending) == (2, 1)
    futures[2].set_result(None)
    deadlines.discard(futures[4])
    ended: list[list[int]] = []
    for _ in range(6):
        await clock.advance(1.0)
        ended.append([seconds for seconds, future in futures.items() if future.done() and future.exception()])
    assert ended == [[1], [1], [3, 1], [3, 1], [3, 1, 5], [3, 1, 5]]
    assert clock.pending == 0


async def test_no_alarm_without_futures(graphflow_runner: asyncio.Runner) -> None:
    """The loop is not woken later."""
    clock = CountingClock()
    deadlines = Deadlines(clock)
    futures: list[Future[None]] = [asyncio.get_running_loop().create_future() for _ in range(3)]
    for future in futures:
        deadlines.add(future, 10**9, error)
    for future in futures:
        assert clock.pending == 1
        deadlines.discard(future)
    assert clock.pending == 0
    deadlines.discard(futures[0])
    deadlines.add(futures[0], 10**9, error)
    assert (clock.set, clock.pending) == (2, 1)
    await clock.advance(1.0)
    assert futures[0].exception() is not None
