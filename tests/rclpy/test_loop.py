"""The event loop on a thread of its own."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine

import pytest

from graphflow.rclpy.loop import LoopThread


def test_functions_and_coroutines_run_on_the_loops_thread() -> None:
    """And what they return or raise comes back."""
    loop = LoopThread()

    async def soon() -> bool:
        await asyncio.sleep(0)
        return loop.is_here

    assert loop.call(lambda: loop.is_here)
    assert loop.wait(soon)
    assert loop.call(lambda: loop.call(lambda: 3)) == 3  # from the loop itself
    with pytest.raises(ZeroDivisionError):
        loop.call(lambda: 1 // 0)
    assert not loop.is_here
    loop._stop()


def test_a_wait_that_takes_too_long_is_cancelled() -> None:
    """On the loop too."""
    loop, ended = LoopThread(), []

    async def forever() -> None:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            ended.append(True)

    with pytest.raises(TimeoutError):
        loop.wait(forever, timeout=0.01)
    loop.call(lambda: None)
    loop.call(lambda: None)
    assert ended == [True]
    loop._stop()


@pytest.mark.parametrize("where", ["start", "call"])
def test_an_interrupt_before_a_coroutine_runs(monkeypatch: pytest.MonkeyPatch, where: str) -> None:
    """It leaves no coroutine behind that was never awaited."""
    loop, made = LoopThread(), list[int]()

    async def work() -> None:
        """Do nothing."""

    def make() -> Coroutine[object, object, None]:
        made.append(threading.get_ident())
        return work()

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(loop, where, interrupted)
        loop.wait(make)
    assert made == []
    loop.wait(make)
    assert made == [loop.call(threading.get_ident)]
    loop._stop()


def test_its_end_is_told_first() -> None:
    """The last that has asked for it first; nothing is called on it afterwards."""
    loop, told = LoopThread(), list[int]()
    loop.start()
    loop.at_exit += [lambda: told.append(1), lambda: told.append(2)]
    loop._stop()
    loop.soon(told.append, 3)
    assert told == [2, 1]
