"""Clocks: all waits in graph time go through one, so that tests and simulations control time."""

from __future__ import annotations

import asyncio
import time
from abc import ABC, abstractmethod
from collections.abc import AsyncGenerator, Callable
from types import TracebackType
from typing import Protocol

from graphflow.times import Time, to_ns


class Alarm(Protocol):
    """A scheduled call that can be cancelled."""

    def cancel(self) -> None: ...


class Clock(ABC):
    """Time and waiting. Subclasses define the current time and how to schedule a call."""

    def now(self) -> Time:
        """Return the time of day."""
        return Time(self.time_ns())

    @abstractmethod
    def time_ns(self) -> int:
        """Return the time of day in nanoseconds since 1970."""

    @abstractmethod
    def monotonic_ns(self) -> int:
        """Return nanoseconds since an arbitrary fixed point; never decreases."""

    @abstractmethod
    def call_at(self, when_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call `callback` on the loop once `monotonic_ns()` has reached `when_ns`."""

    async def sleep(self, seconds: float) -> None:
        """Wait for `seconds`."""
        await self._sleep_until(self.monotonic_ns() + to_ns(seconds))

    async def _sleep_until(self, when_ns: int) -> None:
        future = asyncio.get_running_loop().create_future()
        handle = self.call_at(when_ns, lambda: _wake(future))
        try:
            await future
        finally:
            handle.cancel()

    async def every(self, period: float | None = None, *, hz: float | None = None) -> AsyncGenerator[int, None]:
        """Count 0, 1, 2, ... every `period` seconds or `hz` times a second; late ticks are skipped."""
        step = period_ns(period, hz)
        start, n = self.monotonic_ns(), 0
        while True:
            yield n
            n = max(n + 1, -(-(self.monotonic_ns() - start) // step))
            await self._sleep_until(start + n * step)

    def timeout(self, seconds: float) -> ClockTimeout:
        """Cancel the block after `seconds` of this clock's time and raise TimeoutError, as `asyncio.timeout` does."""
        return ClockTimeout(self, seconds)


class ClockTimeout:
    """A block that is cancelled after a time on a clock. Made by `Clock.timeout`.

    Attributes:
        until_ns: The deadline by the clock, in nanoseconds; 0 before the block is entered.
    """

    def __init__(self, clock: Clock, seconds: float) -> None:
        self._clock, self._seconds = clock, seconds
        self._scope = asyncio.timeout(None)
        self.until_ns = 0

    async def __aenter__(self) -> None:
        loop = asyncio.get_running_loop()
        self.until_ns = self._clock.monotonic_ns() + to_ns(self._seconds)
        await self._scope.__aenter__()
        # asyncio's scope knows only the loop's time: it has no deadline until this clock's alarm sets it to now.
        self._alarm = self._clock.call_at(self.until_ns, lambda: self._scope.reschedule(loop.time()))

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._alarm.cancel()
        await self._scope.__aexit__(kind, error, trace)


def _wake(future: asyncio.Future[None]) -> None:
    if not future.done():
        future.set_result(None)


def period_ns(period: float | None, hz: float | None) -> int:
    """Convert a period in seconds or a rate in Hz to a period in nanoseconds.

    Raises:
        ValueError: Both or neither are given, or the value is not a positive number.
    """
    if (period is None) == (hz is None):
        raise ValueError("give either a period in seconds or hz=")
    value = period if hz is None else hz
    assert value is not None
    if not 0 < value < float("inf"):
        raise ValueError(f"{'a period' if hz is None else 'hz'} must be a positive number, not {value!r}")
    return max(1, to_ns(value if hz is None else 1 / value))


class WallClock(Clock):
    """The system's clocks: the time of day for stamps, and the loop's monotonic clock for waits."""

    time_ns = staticmethod(time.time_ns)
    monotonic_ns = staticmethod(time.monotonic_ns)

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> Alarm:
        delay = max(0, when_ns - time.monotonic_ns()) / 1e9
        return asyncio.get_running_loop().call_later(delay, callback)
