"""Waking threads."""

from __future__ import annotations

import os
import queue
import signal
import threading
from typing import Any, ClassVar

import pytest

from graphflow.rclpy import wake as wake_module
from graphflow.rclpy.wake import SharedWake, Wake


def test_a_wait_ends_when_somebody_wakes() -> None:
    """From another thread, or before the wait began."""
    wake = Wake()
    threading.Timer(0.01, wake.set).start()
    assert wake.wait(5)
    wake.set()
    wake.set()
    assert wake.wait(0)
    assert not wake.wait(0)  # twice before a wait is once


def test_a_signal_handler_wakes_the_thread_that_it_interrupts() -> None:
    """Which waits, and holds whatever a wait holds."""
    wake = Wake()
    former = signal.signal(signal.SIGUSR1, lambda *_: wake.set())
    try:
        threading.Timer(0.02, os.kill, (os.getpid(), signal.SIGUSR1)).start()
        assert wake.wait(5)
    finally:
        signal.signal(signal.SIGUSR1, former)


def test_a_condition_is_looked_at_again_whenever_somebody_wakes() -> None:
    """And the wait goes on as long as it does not hold."""
    wake, looked = Wake(), [0]

    def third_time() -> bool:
        looked[0] += 1
        if looked[0] < 3:
            wake.set()
        return looked[0] == 3

    assert wake.wait_until(third_time, 5)
    assert not wake.wait_until(lambda: False, 0.01)


def test_all_who_wait_are_woken() -> None:
    """Each with what it was given; what wakes nobody wakes the next."""
    shared, woken = SharedWake(), list[int]()
    at_once = threading.Barrier(3)

    def wait(number: int) -> None:
        with shared.for_one() as wake:
            at_once.wait(5)
            if wake.wait(5):
                woken.append(number)

    threads = [threading.Thread(target=wait, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    at_once.wait(5)
    shared.set()
    for thread in threads:
        thread.join()
    assert sorted(woken) == [0, 1]
    shared.set()
    with shared.for_one() as wake:
        assert wake is shared
        assert wake.wait(0)


def test_a_wait_that_is_longer_than_a_system_call_may_be(monkeypatch: pytest.MonkeyPatch) -> None:
    """It takes several, of which none is longer than the limit."""

    class Queue:
        asked: ClassVar[list[float]] = []

        def get(self, timeout: float) -> None:
            self.asked.append(timeout)
            if len(self.asked) < 3:
                raise queue.Empty

    wake = Wake()
    made: Any = Queue()
    monkeypatch.setattr(wake_module, "LONGEST", 2.0)
    wake._queue = made
    assert wake.wait(1e9)
    assert made.asked == [2.0, 2.0, 2.0]
