"""Timers at work."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import pytest

from graphflow import (
    Group,
    Node,
    Param,
    ParameterError,
    TimerInfo,
    subscription,
    timer,
)
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from tests.runtime.cast import Log, nothing


class Ticker(Node):
    """Notes when it ticks, in tenths of a second since the start."""

    rate = Param(10.0, gt=0.0)

    def __init__(self, takes: float = 0.0, **params: Any) -> None:
        super().__init__(**params)
        self.takes = takes
        self.ticks: list[TimerInfo] = []
        self.running = 0

    @timer(hz=rate)
    async def tick(self, info: TimerInfo) -> None:
        assert self.running == 0
        self.running += 1
        self.ticks.append(info)
        if self.takes:
            await self.clock.sleep(self.takes)
        self.running -= 1

    @property
    def times(self) -> list[int]:
        return [info.expected_ns // 100_000_000 for info in self.ticks]


async def test_a_timer_ticks_once_a_period(graph: Graph) -> None:
    """First one period after the start, and never early."""
    node = Ticker()
    await graph.start(node)
    await graph.clock.advance(0.09)
    assert node.ticks == []

    await graph.clock.advance(0.5)

    assert node.times == [1, 2, 3, 4, 5]
    assert all(info.actual_ns == info.expected_ns and info.skipped == 0 for info in node.ticks)


async def test_a_slow_run_skips_periods_and_keeps_the_phase(graph: Graph) -> None:
    """With runs of 0.25 s every third period of 0.1 s has one, and the others are counted."""
    node = Ticker(takes=0.25)
    await graph.start(node)

    await graph.clock.advance(1.05)

    assert node.times == [1, 4, 7, 10]
    assert [info.skipped for info in node.ticks] == [0, 2, 2, 2]


async def test_a_blocked_loop_skips_periods_and_keeps_the_phase(graph: Graph) -> None:
    """A late run reports it, missed runs are not repeated, and the next run is in phase."""
    node, infos = Node("n"), Log()
    ticking = node.create_timer(0.1, infos, takes_info=True)
    await graph.start(node)
    await graph.clock.advance(0.1)
    graph.clock._elapsed_ns += 350_000_000  # as if something had computed for so long
    await graph.clock.advance(0.25)

    ms = 1_000_000
    assert infos == [
        TimerInfo(100 * ms, 100 * ms, 0),
        TimerInfo(200 * ms, 450 * ms, 2),
        TimerInfo(500 * ms, 500 * ms, 0),
        TimerInfo(600 * ms, 600 * ms, 0),
        TimerInfo(700 * ms, 700 * ms, 0),
    ]
    assert ticking.skipped == 2


async def test_a_timer_that_waits_for_its_group_is_not_doubled(graph: Graph) -> None:
    """While its group is busy one run waits and the rest are skipped."""
    gate, log = asyncio.Event(), Log()

    class Busy(Node):
        motion = Group(1)

        @subscription(String, "x", group=motion)
        async def hold(self, _: String) -> None:
            await gate.wait()

        @timer(0.1, group=motion)
        async def tick(self, info: TimerInfo) -> None:
            log((info.expected_ns // 100_000_000, info.skipped))

    await graph.start(Busy())
    graph.publisher(String, "/x").publish(String())
    await graph.clock.advance(0.55)
    assert log == []
    gate.set()
    await graph.clock.advance(0.2)

    assert log == [(1, 0), (6, 4), (7, 0)]


async def test_a_changed_period_holds_from_then_on(graph: Graph) -> None:
    """The next run is one new period after the change."""
    node = Ticker()
    await graph.start(node)
    await graph.clock.advance(0.15)

    node.rate = 2.0
    await graph.clock.advance(1.2)

    assert [info.expected_ns / 1e9 for info in node.ticks] == [0.1, 0.65, 1.15]


async def test_another_parameter_leaves_the_phase_alone(graph: Graph) -> None:
    """Only the parameter of its rate restarts it."""

    class Two(Ticker):
        other = Param(1.0)

    node = Two()
    await graph.start(node)
    await graph.clock.advance(0.15)
    node.other = 2.0
    await graph.clock.advance(0.1)

    assert node.times == [1, 2]


async def test_a_rate_that_is_none_is_refused(graph: Graph) -> None:
    """A parameter of a timer's rate cannot be set to an invalid period; the old value stays."""

    class Loose(Node):
        rate = Param(10.0)
        ticks = 0

        @timer(hz=rate)
        async def tick(self) -> None:
            self.ticks += 1

    node = Loose()
    await graph.start(node)
    for wrong in (0.0, -1.0, float("inf")):
        with pytest.raises(ParameterError, match=r"'rate' .*must be a positive number"):
            node.rate = wrong
    await graph.clock.advance(1.0)

    assert node.rate == 10.0
    assert node.ticks == 10
    with pytest.raises(ParameterError, match=r"'rate' .*must be a positive number"):
        Loose(rate=0.0)


@pytest.mark.parametrize("period", [0.0, -1.0, float("nan"), float("inf")])
async def test_a_period_must_be_positive(graph: Graph, period: float) -> None:
    """A timer that would always be due is refused, when it is made and when it is changed."""
    node = Node("n")
    with pytest.raises(ValueError, match=r"period must be .*positive"):
        node.create_timer(period, nothing)
    ticking = node.create_timer(1.0, nothing)
    with pytest.raises(ValueError, match=r"period must be .*positive"):
        ticking.period = period

    assert ticking.period == 1.0


async def test_a_timer_can_be_stopped_and_begun_again(graph: Graph) -> None:
    """`cancel` ends its runs, `reset` begins one period from then."""
    node, log = Node("n"), Log()
    ticking = node.create_timer(0.1, lambda: log(graph.clock.monotonic_ns() // 1_000_000))
    await graph.start(node)
    await graph.clock.advance(0.15)
    ticking.cancel()
    await graph.clock.advance(1.0)
    ticking.reset()
    await graph.clock.advance(0.2)
    ticking.close()
    ticking.close()
    await graph.clock.advance(1.0)

    assert log == [100, 1250, 1350]


async def test_an_error_in_a_timer_is_logged_and_the_next_run_comes(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """The node goes on."""
    node = Node("n")

    async def wrong() -> None:
        raise ValueError("every time")

    node.create_timer(1.0, wrong)
    await graph.start(node)
    await graph.clock.advance(3.0)

    assert [r.getMessage() for r in caplog.records] == ["wrong: ValueError: every time"] * 3


async def test_a_timer_may_run_in_a_thread(graph: Graph) -> None:
    """A blocking body leaves the loop free."""
    node, ticked = Node("n"), asyncio.Event()
    loop = asyncio.get_running_loop()
    threads: list[bool] = []

    def work() -> None:
        threads.append(threading.current_thread() is threading.main_thread())
        loop.call_soon_threadsafe(ticked.set)

    node.create_timer(0.1, work, thread=True)
    await graph.start(node)
    await graph.clock.advance(0.1)
    await ticked.wait()

    assert threads == [False]


@pytest.mark.parametrize("kind", ["subscription", "service", "timer"])
async def test_a_coroutine_cannot_run_in_a_thread(graph: Graph, kind: str) -> None:
    """`thread=True` with an `async def` is refused where it is written: its body would never run."""
    node = Node("n")

    async def handler(_: object = None) -> None:
        """Do nothing."""

    make: dict[str, Callable[[], object]] = {
        "subscription": lambda: node.create_subscription(String, "x", handler, thread=True),
        "service": lambda: node.create_service(Empty, "x", handler, thread=True),
        "timer": lambda: node.create_timer(1.0, handler, thread=True),
    }
    with pytest.raises(ValueError, match="thread=True is for `def`"):
        make[kind]()
