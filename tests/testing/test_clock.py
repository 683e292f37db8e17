"""The clock that a test turns, and coming to rest."""

from __future__ import annotations

import asyncio

import pytest

from graphflow.testing import clock as clock_module
from graphflow.testing.clock import START_NS, ManualClock, settle


async def test_time_stands_still_until_it_is_advanced(graphflow_runner: asyncio.Runner) -> None:
    """Both clocks advance by exactly the requested time."""
    clock = ManualClock()
    await settle()
    assert (clock.monotonic_ns(), clock.time_ns()) == (0, START_NS)

    await clock.advance(1.5)

    assert (clock.monotonic_ns(), clock.time_ns()) == (1_500_000_000, START_NS + 1_500_000_000)
    assert clock.now().nanoseconds == clock.time_ns()


async def test_alarms_ring_in_order_at_their_time(graphflow_runner: asyncio.Runner) -> None:
    """By time, and those of one time in the order in which they were set."""
    clock = ManualClock()
    rung: list[tuple[str, int]] = []

    def alarm(name: str, when: int) -> None:
        clock.call_at(when, lambda: rung.append((name, clock.monotonic_ns())))

    for name, when in (("c", 3), ("a", 1), ("b1", 2), ("b2", 2), ("late", 10)):
        alarm(name, when)
    await clock.advance(5e-9)

    assert rung == [("a", 1), ("b1", 2), ("b2", 2), ("c", 3)]
    assert clock.monotonic_ns() == 5


async def test_each_alarm_has_its_consequences_before_the_next(graphflow_runner: asyncio.Runner) -> None:
    """An alarm's consequences, new alarms included, happen before time advances."""
    clock = ManualClock()
    log: list[tuple[str, int]] = []

    async def later() -> None:
        await asyncio.sleep(0)
        log.append(("consequence", clock.monotonic_ns()))
        clock.call_at(2, lambda: log.append(("new alarm", clock.monotonic_ns())))

    tasks: list[asyncio.Task[None]] = []
    clock.call_at(1, lambda: tasks.append(asyncio.get_running_loop().create_task(later())))
    clock.call_at(3, lambda: log.append(("next", clock.monotonic_ns())))
    await clock.advance(1.0)

    assert log == [("consequence", 1), ("new alarm", 2), ("next", 3)]
    assert tasks[0].done()


async def test_an_alarm_that_is_due_rings_without_advance(graphflow_runner: asyncio.Runner) -> None:
    """At the next `advance`, even by zero, and never inside `call_at`."""
    clock = ManualClock()
    await clock.advance(1.0)
    rung: list[int] = []
    clock.call_at(0, lambda: rung.append(clock.monotonic_ns()))
    assert rung == []

    await clock.advance(0)

    assert rung == [1_000_000_000]


async def test_a_cancelled_alarm_does_not_ring(graphflow_runner: asyncio.Runner) -> None:
    """Cancelled before, or by an alarm of the same time; twice is harmless."""
    clock = ManualClock()
    never = clock.call_at(5, lambda: pytest.fail("cancelled"))
    clock.call_at(5 - 1, never.cancel)
    other = clock.call_at(5, lambda: pytest.fail("cancelled"))
    other.cancel()
    other.cancel()

    await clock.advance(1.0)


async def test_alarms_ring_outside_of_the_tests_task(graphflow_runner: asyncio.Runner) -> None:
    """As in production: an alarm's callback does not run in the test's task."""
    clock = ManualClock()
    seen: list[object] = []

    def look() -> None:
        try:
            seen.append(asyncio.current_task())
        except RuntimeError:
            seen.append("no loop")

    clock.call_at(1, look)
    await clock.advance(1.0)

    assert seen == [None]


async def test_settle_waits_for_all_that_needs_no_time(graphflow_runner: asyncio.Runner) -> None:
    """Chains of tasks and callbacks are followed to their end."""
    log: list[int] = []

    async def chain(n: int) -> None:
        await asyncio.sleep(0)
        if n:
            await asyncio.create_task(chain(n - 1))
        log.append(n)

    running = asyncio.create_task(chain(50))
    await settle()

    assert running.done()
    assert log == list(range(51))


async def test_several_may_settle_at_once(graphflow_runner: asyncio.Runner) -> None:
    """They do not wait for each other, and each finds the work of the others done."""
    log: list[str] = []

    async def work() -> None:
        for _ in range(5):
            await asyncio.sleep(0)
        log.append("worked")

    async def settles(name: str) -> None:
        await settle()
        log.append(name)

    running = asyncio.create_task(work())
    others = [asyncio.create_task(settles(n)) for n in ("one", "two")]
    await settle()
    await asyncio.gather(running, *others)

    assert log[0] == "worked"
    assert sorted(log[1:]) == ["one", "two"]


async def test_what_never_rests_is_an_error(graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    """A task that keeps itself awake is named as the fault, not a test that hangs."""
    monkeypatch.setattr(clock_module, "_TURNS", 100)

    async def restless() -> None:
        while True:
            await asyncio.sleep(0)

    running = asyncio.create_task(restless())
    with pytest.raises(RuntimeError, match="does not settle"):
        await settle()
    running.cancel()
    await settle()


async def test_time_does_not_go_back(graphflow_runner: asyncio.Runner) -> None:
    """As a slip of the sign would have it."""
    with pytest.raises(ValueError, match=r"time does not go back: advance\(-1\)"):
        await ManualClock().advance(-1)
