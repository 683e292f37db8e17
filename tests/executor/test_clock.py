"""Waiting in graph time."""

from __future__ import annotations

import asyncio
import time

import pytest

from graphflow.executor.clock import Clock, WallClock, period_ns
from graphflow.testing.clock import START_NS, ManualClock, settle


async def test_sleep_ends_when_its_time_has_come(graphflow_runner: asyncio.Runner) -> None:
    """Not before, and in the order of their times, not of their beginnings."""
    clock = ManualClock()
    woken: list[str] = []

    async def sleep(name: str, seconds: float) -> None:
        await clock.sleep(seconds)
        woken.append(name)

    async with asyncio.TaskGroup() as group:
        for name, seconds in (("late", 2.0), ("early", 1.0), ("now", 0.0)):
            group.create_task(sleep(name, seconds))
        await clock.advance(0.999_999_999)
        assert woken == ["now"]
        await clock.advance(0.000_000_001)
        assert woken == ["now", "early"]
        await clock.advance(1.0)

    assert woken == ["now", "early", "late"]


async def test_a_cancelled_sleep_leaves_nothing_behind(graphflow_runner: asyncio.Runner) -> None:
    """The alarm is taken back with the sleep."""
    clock = ManualClock()
    sleeper = asyncio.create_task(clock.sleep(1.0))
    await settle()
    sleeper.cancel()
    await clock.advance(2.0)

    assert sleeper.cancelled()


async def test_every_counts_once_a_period(graphflow_runner: asyncio.Runner) -> None:
    """The first turn is at once, the others each one period later."""
    clock = ManualClock()
    turns: list[tuple[int, int]] = []

    async def count() -> None:
        async for n in clock.every(0.5):
            turns.append((n, clock.monotonic_ns() // 1_000_000))

    counting = asyncio.create_task(count())
    await clock.advance(1.6)
    counting.cancel()

    assert turns == [(0, 0), (1, 500), (2, 1000), (3, 1500)]


async def test_every_skips_and_keeps_phase(graphflow_runner: asyncio.Runner) -> None:
    """Ticks missed in a slow body are skipped, and the numbers reveal it."""
    clock = ManualClock()
    turns: list[tuple[int, int]] = []

    async def count() -> None:
        async for n in clock.every(hz=10):
            turns.append((n, clock.monotonic_ns() // 1_000_000))
            await clock.sleep(0.25 if n == 1 else 0)

    counting = asyncio.create_task(count())
    await clock.advance(0.55)
    counting.cancel()

    assert turns == [(0, 0), (1, 100), (4, 400), (5, 500)]


async def test_a_body_as_long_as_a_period_misses_no_turn(graphflow_runner: asyncio.Runner) -> None:
    """Being ready exactly on time is in time."""
    clock = ManualClock()
    turns: list[int] = []

    async def count() -> None:
        async for n in clock.every(0.1):
            turns.append(n)
            await clock.sleep(0.1)

    counting = asyncio.create_task(count())
    await clock.advance(0.35)
    counting.cancel()

    assert turns == [0, 1, 2, 3]


async def test_a_timeout_by_the_clock(graphflow_runner: asyncio.Runner) -> None:
    """The block is cancelled at the clock's time, and raises TimeoutError."""
    clock = ManualClock()
    log: list[str] = []

    async def wait() -> None:
        try:
            async with clock.timeout(1.0):
                try:
                    await asyncio.Event().wait()
                finally:
                    log.append("cleaned up")
        except TimeoutError:
            log.append("late")

    waiting = asyncio.create_task(wait())
    await clock.advance(0.9)
    assert log == []
    await clock.advance(0.1)
    await waiting

    assert log == ["cleaned up", "late"]


async def test_a_timeout_that_is_not_needed(graphflow_runner: asyncio.Runner) -> None:
    """A block that ends in time is never cancelled."""
    clock = ManualClock()
    async with clock.timeout(1.0):
        await asyncio.sleep(0)
    await clock.advance(5.0)


async def test_a_cancellation_in_a_timeout_stays_one(graphflow_runner: asyncio.Runner) -> None:
    """Only the clock's own cancellation becomes a TimeoutError; errors pass through."""
    clock = ManualClock()

    async def wait() -> None:
        async with clock.timeout(1.0):
            await asyncio.Event().wait()

    waiting = asyncio.create_task(wait())
    await settle()
    waiting.cancel()
    await settle()
    assert waiting.cancelled()

    with pytest.raises(ValueError, match="own"):
        async with clock.timeout(1.0):
            raise ValueError("its own")


@pytest.mark.parametrize(
    ("period", "hz", "expected"),
    [(0.5, None, 500_000_000), (None, 4.0, 250_000_000), (2, None, 2_000_000_000), (1e-12, None, 1), (None, 1e12, 1)],
)
def test_a_period_or_a_rate(period: float | None, hz: float | None, expected: int) -> None:
    """Either gives nanoseconds, at least one."""
    assert period_ns(period, hz) == expected


@pytest.mark.parametrize(
    ("period", "hz", "text"),
    [
        (None, None, "give either a period in seconds or hz="),
        (1.0, 1.0, "give either a period in seconds or hz="),
        (0.0, None, "a period must be a positive number, not 0.0"),
        (-1.0, None, "a period must be a positive number, not -1.0"),
        (float("nan"), None, "a period must be a positive number, not nan"),
        (float("inf"), None, "a period must be a positive number, not inf"),
        (None, 0.0, "hz must be a positive number, not 0.0"),
        (None, float("inf"), "hz must be a positive number, not inf"),
    ],
)
def test_what_is_no_period(period: float | None, hz: float | None, text: str) -> None:
    """The error has the value and the requirement."""
    with pytest.raises(ValueError) as caught:
        period_ns(period, hz)
    assert str(caught.value) == text


async def test_the_wall_clock_is_the_systems(graphflow_runner: asyncio.Runner) -> None:
    """Time of day for stamps, monotonic time for waiting, and a call when that has come."""
    clock = WallClock()
    before, monotonic = time.time_ns(), time.monotonic_ns()

    assert before <= clock.now().nanoseconds <= time.time_ns()
    assert monotonic <= clock.monotonic_ns() <= time.monotonic_ns()

    rung = asyncio.Event()
    due = clock.monotonic_ns() + 1_000_000
    clock.call_at(due, rung.set)
    never = clock.call_at(due, lambda: pytest.fail("cancelled, and called all the same"))
    never.cancel()
    await rung.wait()
    assert clock.monotonic_ns() >= due
    await clock.sleep(0)


def test_a_clock_must_say_what_time_it_is() -> None:
    """The base class is abstract in all three methods."""
    with pytest.raises(TypeError, match=r"call_at.*monotonic_ns.*time_ns"):
        Clock()  # type: ignore[abstract]


def test_manual_clocks_begin_at_the_same_time() -> None:
    """Stamps in tests are the same in every run."""
    assert ManualClock().now().nanoseconds == START_NS
