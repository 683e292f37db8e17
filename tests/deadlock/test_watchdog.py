"""The watch over an event loop: one that idles is left alone, one that is busy is rung, one that is stuck is told.

A test blocks the loop itself, until the watching thread has done what it waits for.
"""

from __future__ import annotations

import asyncio
import logging
import operator
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from itertools import starmap
from queue import SimpleQueue
from typing import Any, cast

import pytest

from graphflow.analysis.frames import Frame
from graphflow.deadlock import watchdog as module
from graphflow.deadlock.watchdog import Watchdog
from graphflow.runtime.logs import logger as logger_module

LIMIT = 30.0
"""Seconds that the watching thread gets to do anything."""


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Everything happens a hundred times as soon."""
    monkeypatch.setattr(module, "LOOK_EVERY", 0.005)
    monkeypatch.setattr(module, "ANSWER_WITHIN", 0.001)
    monkeypatch.setattr(module, "REPORT_AFTER", 0.01)


class Watched:
    """The loop of a test under watch."""

    def __init__(self) -> None:
        self.seen = threading.Semaphore(0)
        self.watchdog = Watchdog(asyncio.get_running_loop(), self.seen.release)

    def block(self, times: int) -> None:
        """Keep the loop until so many calls have told that it is blocked."""
        for _ in range(times):
            assert self.seen.acquire(timeout=LIMIT)


@pytest.fixture
def watched(graphflow_runner: asyncio.Runner) -> Iterator[Watched]:
    async def made() -> Watched:
        return Watched()

    it = graphflow_runner.run(made())
    yield it
    it.watchdog.close()


async def until(condition: Callable[[], bool]) -> None:
    """Let the loop go on until the watching thread has come so far."""
    while not condition():
        await asyncio.sleep(0)


async def test_a_blocked_loop(graphflow_runner: asyncio.Runner, watched: Watched) -> None:
    """It is told again and again while it lasts, is late once, and is known for as long as it was."""
    watchdog = watched.watchdog
    watchdog.start()
    watched.block(times=3)
    assert watchdog.is_blocked
    assert watchdog.blocked_for > module.ANSWER_WITHIN
    await until(lambda: watchdog.late > 0)

    assert watchdog.longest > 3 * module.ANSWER_WITHIN
    await until(lambda: not watchdog.is_blocked)


async def test_the_report_of_a_blocked_loop(
    graphflow_runner: asyncio.Runner, watched: Watched, caplog: pytest.LogCaptureFixture
) -> None:
    """After a while the stack is told, with the line that blocks it, once; and then that it goes on."""

    def told() -> list[str]:
        return [r.getMessage() for r in caplog.records if r.levelno >= logging.WARNING and "event loop" in r.message]

    watched.watchdog.start()
    while not told():
        watched.block(times=1)  # here
    watched.block(times=5)
    await until(lambda: len(told()) > 1)

    first, second, *_ = told()
    assert first.startswith("the event loop has been blocked for 0.")
    assert "await self.offload(...)" in first
    head, _, stack = first.partition("\n")
    assert f" in {__file__}:" in head
    assert " in block: nothing else" in head
    assert f"\n  {__file__}:" in stack
    assert "graphflow/executor" not in stack
    assert second.startswith("the event loop runs again after ")


async def test_a_report_from_within_graphflow(
    graphflow_runner: asyncio.Runner, watched: Watched, caplog: pytest.LogCaptureFixture
) -> None:
    """The line of the program that called graphflow is named, although the loop called the program directly."""

    @dataclass
    class Generated:
        """Its constructor is code without a file."""

        times: int

        def __post_init__(self) -> None:
            while not told():
                frozen(self.times)

    def told() -> list[str]:
        return [r.getMessage() for r in caplog.records if "has been blocked" in r.getMessage()]

    def frozen(times: int) -> None:
        for _ in range(times):
            assert watched.seen.acquire(timeout=LIMIT)

    # As if both were graphflow's own.
    for fn in (Generated.__post_init__, frozen):
        fn.__code__ = fn.__code__.replace(co_filename=logger_module.__file__)
    watched.watchdog.start()
    asyncio.get_running_loop().call_soon(lambda: Generated(times=1))
    await asyncio.sleep(0)
    assert f" in {__file__}:" in told()[0].partition("\n")[0]
    assert " in <lambda>" in told()[0]


@pytest.mark.parametrize(
    ("load", "processor_time", "level", "text"),
    [
        (9.0, 0.4, logging.WARNING, "the event loop has not run for 4.0 s, in which this process got 0.4 s of "
                                    "processor time; the machine seems to be overloaded, with a load average of 9.0"),
        (9.0, 2.5, logging.ERROR, "the event loop has been blocked for 4.0 s, with no line of this program on its "
                                  "stack: nothing else in this process can run."),
        (0.5, 0.0, logging.ERROR, "the event loop has been blocked for 4.0 s, with no line of this program on its "
                                  "stack: nothing else in this process can run."),
    ],
)  # fmt: skip
def test_an_overloaded_machine(
    monkeypatch: pytest.MonkeyPatch, load: float, processor_time: float, level: int, text: str
) -> None:
    """It is named where there is more to do than processors, and the process got little of them."""
    monkeypatch.setattr("os.getloadavg", lambda: (load, 0.0, 0.0))
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    assert module._of_others(4.0, processor_time) == (level, text)


async def test_a_block_without_code_of_the_users(
    graphflow_runner: asyncio.Runner,
    watched: Watched,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is told later, and without advice to the user."""
    monkeypatch.setattr(module, "is_users", lambda _: False)
    monkeypatch.setattr(module, "is_users_frame", lambda _: False)
    monkeypatch.setattr(module, "REPORT_OTHERS_AFTER", 0.2)
    watched.watchdog.start()
    while not (told := [r.getMessage() for r in caplog.records if "the event loop has" in r.getMessage()]):
        watched.block(times=1)
    watched.watchdog.close()
    head, _, stack = told[0].partition("\n")
    assert float(head.partition(" for ")[2].partition(" s")[0]) >= 0.2
    assert module._REMEDY not in told[0]
    assert " in block" in stack


def test_the_remedy_for_code_without_a_node() -> None:
    """It has no `self`."""

    def frame() -> Frame:
        return cast("Frame", sys._getframe())

    class Lamp:
        def frame(self) -> Frame:
            return cast("Frame", sys._getframe())

        async def work(self) -> Frame:
            return cast("Frame", sys._getframe())

    assert module._remedy([frame()]) == module._OUTSIDE
    assert module._remedy([Lamp().frame(), frame()]) == module._OF_DEF
    with pytest.raises(StopIteration) as caught:
        Lamp().work().send(None)
    assert module._remedy([caught.value.value]) == module._REMEDY


async def _never_pauses(see: Callable[[Frame], None]) -> None:
    while True:
        see(cast("Frame", sys._getframe()))


def test_the_remedy_for_a_loop_that_cannot_pause() -> None:
    """Its own line, and what to write there."""
    seen: list[Frame] = []

    def see(frame: Frame) -> None:
        seen.append(frame)
        raise StopAsyncIteration

    with pytest.raises(StopAsyncIteration):
        asyncio.run(_never_pauses(see))
    told = f"test_watchdog.py:{_never_pauses.__code__.co_firstlineno + 1}: this loop never awaits, so no other handler"
    assert module._of_loop(seen[0]).startswith(told)
    assert module._of_loop(cast("Frame", sys._getframe())) == ""


async def test_many_short_blocks(
    graphflow_runner: asyncio.Runner,
    watched: Watched,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """None of them is long, and each look finds one: they are told together, once for each line."""
    monkeypatch.setattr(module, "REPORT_AFTER", LIMIT)

    def told() -> list[str]:
        return [r.message for r in caplog.records if "the event loop was blocked in 7 of 10 checks" in r.message]

    watched.watchdog.longest = 1e6  # of a block before, which was told then
    watched.watchdog.start()
    late = 0
    while not told():
        watched.block(times=1)
        while watched.watchdog.late == late:
            await asyncio.sleep(0)
        late = watched.watchdog.late
        while watched.seen.acquire(blocking=False):
            """It was told more than once that this block lasts."""
    [text] = told()
    assert f"mostly in {__file__}:" in text
    assert "in block: Await the slow part" in text
    assert "1000000.0 s" not in text


async def test_short_blocks_with_breaks(
    graphflow_runner: asyncio.Runner, watched: Watched, caplog: pytest.LogCaptureFixture
) -> None:
    """Looks that find the loop free, or none of the user's lines, count as such."""
    for place in ["a.py:1 in f", ""] * 20:
        watched.watchdog._count_short(place, 0.2)
    assert caplog.messages == []
    for _ in range(20):
        watched.watchdog._count_short("a.py:1 in f", 0.2)
    assert len(caplog.messages) == 1


async def test_what_counts_as_busy(graphflow_runner: asyncio.Runner, watched: Watched) -> None:
    """A loop whose thread is anywhere but in its selector; one that only waits is left alone."""
    is_busy = watched.watchdog._is_busy

    def until_it_idles() -> str:
        while is_busy():
            """Look again."""
        return "idle"

    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(is_busy).result(LIMIT)  # this line keeps it
    assert await asyncio.to_thread(until_it_idles) == "idle"


class NativeLoop:
    """A loop that is not written in Python, as uvloop's is not: it has no frames of its own."""

    def __init__(self) -> None:
        self._calls: SimpleQueue[tuple[Any, ...]] = SimpleQueue()
        self.thread = threading.Thread(target=self.run_forever)

    def run_forever(self) -> None:
        deque(starmap(operator.call, iter(self._calls.get, ())), maxlen=0)

    def is_running(self) -> bool:
        return self.thread.is_alive()

    def call_soon_threadsafe(self, callback: Callable[..., object], *args: object) -> None:
        self._calls.put((callback, *args))

    def stop(self) -> None:
        self._calls.put(())


@pytest.fixture
def native() -> Iterator[tuple[NativeLoop, Watchdog]]:
    loop = NativeLoop()
    loop.thread.start()
    made: Future[Watchdog] = Future()
    loop.call_soon_threadsafe(lambda: made.set_result(Watchdog(cast(asyncio.AbstractEventLoop, loop), lambda: None)))
    yield loop, made.result(LIMIT)
    loop.stop()
    loop.thread.join(LIMIT)


def test_a_native_loop_that_idles(native: tuple[NativeLoop, Watchdog]) -> None:
    """Once it has answered, it is known where its thread waits, and it is pinged now and then only."""
    _, watchdog = native
    watchdog._ping()

    assert [watchdog._is_busy() for _ in range(2 * module.RING_ANYWAY)] == 2 * [False, False, False, True]


def test_a_native_loop_that_is_busy(native: tuple[NativeLoop, Watchdog]) -> None:
    """It is found in any other place."""
    loop, watchdog = native
    watchdog._ping()
    is_kept, goes_on = threading.Event(), threading.Event()

    def keep() -> None:
        is_kept.set()
        goes_on.wait(LIMIT)

    loop.call_soon_threadsafe(keep)
    assert is_kept.wait(LIMIT)
    assert watchdog._is_busy()
    goes_on.set()


def test_uvloop_that_idles() -> None:
    """It is left alone."""
    uvloop = pytest.importorskip("uvloop", reason="the extra `fast` is not installed")

    async def watch() -> list[bool]:
        watchdog = Watchdog(asyncio.get_running_loop(), lambda: None)
        await asyncio.to_thread(watchdog._ping)
        return await asyncio.to_thread(lambda: [watchdog._is_busy() for _ in range(module.RING_ANYWAY)])

    assert uvloop.run(watch()).count(True) == 1


async def test_before_it_looks(graphflow_runner: asyncio.Runner, watched: Watched) -> None:
    """A loop that was never rung is not blocked."""
    assert (watched.watchdog.blocked_for, watched.watchdog.is_blocked) == (0.0, False)
    assert (watched.watchdog.late, watched.watchdog.longest) == (0, 0.0)


def test_a_loop_that_does_not_run() -> None:
    """Whoever runs it has stopped, and may go on later: it is not busy; one that is closed cannot be rung."""
    loop = asyncio.new_event_loop()
    told: list[object] = []
    watchdog = Watchdog(loop, lambda: told.append(None))

    assert not watchdog._is_busy()
    loop.close()
    watchdog._ping()
    assert (told, watchdog.is_blocked, watchdog.late) == ([], False, 0)


async def test_closing_it(graphflow_runner: asyncio.Runner, watched: Watched) -> None:
    """The watching thread ends, also while the loop is blocked."""
    watched.watchdog.start()
    watched.block(times=1)
    watched.watchdog.close()
    watched.watchdog._thread.join(LIMIT)

    assert not watched.watchdog._thread.is_alive()


class Locked:
    """Code that waits for what is taken."""

    def __init__(self) -> None:
        self.lock, self.queue = threading.Lock(), SimpleQueue[type[OSError]]()

    def by_with(self) -> None:
        with self.lock:
            pass

    def by_name(self, lock: Any) -> None:
        lock.acquire()
        lock.release()

    def otherwise(self) -> None:
        with suppress(self.queue.get()):
            pass


@pytest.mark.parametrize(
    ("waits", "name"),
    [(Locked.by_with, "self.lock"), (lambda it: it.by_name(it.lock), "lock"), (Locked.otherwise, "")],
)
def test_a_lock_of_threads(waits: Callable[[Locked], None], name: str) -> None:
    """The loop that waits for one is told what to have in its place; nothing else is taken for one."""
    it = Locked()
    it.lock.acquire()
    thread = threading.Thread(target=waits, args=(it,), daemon=True)
    thread.start()
    lines = [Locked.by_with, Locked.by_name, Locked.otherwise]
    until = time.monotonic() + LIMIT
    while True:
        frame = sys._current_frames()[cast("int", thread.ident)]
        if any(frame.f_code is fn.__code__ and frame.f_lineno == frame.f_code.co_firstlineno + 1 for fn in lines):
            break
        assert time.monotonic() < until
    told = module._of_lock(cast("Any", frame))
    assert told.startswith(f"{name} is a lock of threads") if name else told == ""
    it.queue.put(OSError)
    it.lock.release()
    thread.join(LIMIT)
