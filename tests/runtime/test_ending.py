"""How a program that runs nodes is ended."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest

from graphflow.runtime import ending
from graphflow.runtime.ending import _stop_signals, catch_signals, hindrances
from tests.cases import slow
from tests.conftest import Machine

LINGERING = """
import asyncio, graphflow

class Lingering(graphflow.Node):
    async def on_start(self):
        print("up", flush=True)

    async def on_shutdown(self):
        await asyncio.sleep(60)

graphflow.run(Lingering)
"""


@slow
@pytest.mark.real
def test_a_node_that_takes_long_to_stop_says_so(machine: Machine, tmp_path: Path) -> None:
    """After a second, and a second Ctrl-C ends it."""
    file = tmp_path / "lingering.py"
    file.write_text(LINGERING)
    program = machine.start_python(str(file))
    program.wait_for("up")
    program.process.send_signal(signal.SIGINT)
    program.wait_for("still stopping; Ctrl-C again ends it without cleanup")
    program.process.send_signal(signal.SIGINT)
    assert program.wait() == 1
    assert "ended without cleanup" in program.text


def test_a_hangup_that_is_ignored() -> None:
    """As under `nohup`, stays ignored."""
    former = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert signal.SIGHUP not in list(_stop_signals())
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
        assert signal.SIGHUP in list(_stop_signals())
    finally:
        signal.signal(signal.SIGHUP, former)


def test_signals_that_come_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process and its group may be signalled together: the second signal is ignored."""
    started: list[threading.Timer] = []

    def start(reminder: threading.Timer) -> None:
        started.append(reminder)
        if len(started) == 1:
            signal.raise_signal(signal.SIGTERM)

    async def be_asked() -> None:
        restore = catch_signals(stop := asyncio.Event())
        try:
            signal.raise_signal(signal.SIGTERM)
            await asyncio.wait_for(stop.wait(), 5.0)
        finally:
            restore()

    monkeypatch.setattr(threading.Timer, "start", start)
    asyncio.run(be_asked())
    assert len(started) == 1


def vendors_handler(*_: object) -> None:
    """A handler that a library may install."""


async def test_who_takes_a_signal_is_named(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Once: nodes that do not hear of their end cannot stop in order."""
    monkeypatch.setattr(ending, "CHECK_AFTER", 0.0)
    restore = catch_signals(asyncio.Event())
    try:
        signal.signal(signal.SIGTERM, vendors_handler)
        for _ in range(5):
            await asyncio.sleep(0)
    finally:
        restore()
    [record] = caplog.records
    line = vendors_handler.__code__.co_firstlineno
    assert f"test_ending.vendors_handler ({__file__}:{line}) has replaced the handler of SIGTERM" in record.getMessage()
    assert "on_shutdown will not run" in record.getMessage()


async def test_handlers_that_stay_are_no_news(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """There is no warning."""
    monkeypatch.setattr(ending, "CHECK_AFTER", 0.0)
    restore = catch_signals(asyncio.Event())
    for _ in range(5):
        await asyncio.sleep(0)
    restore()
    assert caplog.records == []


def test_looks_become_rare(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each comes after twice as long as the one before, up to a minute: a process that idles is not woken for them."""
    waits: list[float] = []
    looks: list[Callable[[], None]] = []

    def call_later(wait: float, look: Callable[..., None], *args: object) -> SimpleNamespace:
        waits.append(wait)
        looks.append(partial(look, *args))
        return SimpleNamespace(cancel=lambda: None)

    with monkeypatch.context() as patch:
        patch.setattr(asyncio, "get_running_loop", lambda: SimpleNamespace(call_later=call_later))
        restore = catch_signals(asyncio.Event())
    for _ in range(8):
        looks.pop()()
    restore()
    assert waits == [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0, 60.0]


def test_a_thread_that_works_is_named() -> None:
    """With its line; daemon threads are left out, since the process does not wait for them."""
    gate, inside = threading.Event(), threading.Semaphore(0)

    def works() -> None:
        inside.release()
        gate.wait()

    threads = [threading.Thread(target=works, name=name, daemon=name == "demon") for name in ("smith", "demon")]
    for thread in threads:
        thread.start()
        assert inside.acquire(timeout=10.0)
    told = [text for text in hindrances() if "'smith'" in text or "'demon'" in text]
    gate.set()
    for thread in threads:
        thread.join()
    assert [text.partition(" in ")[2] for text in told] == ["works, thread 'smith'"]


def wait_for(gate: Path) -> None:
    """Work for another process, until there is a file."""
    while not gate.exists():
        os.sched_yield()


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_process_pool_at_work_is_named(tmp_path: Path) -> None:
    """With its processes, which can then be ended."""
    gate = tmp_path / "gate"
    with ProcessPoolExecutor(1) as pool:
        work = pool.submit(wait_for, gate)
        told = [text for text in hindrances() if "process pool" in text]
        gate.touch()
        work.result(30.0)
    assert len(told) == 1
    assert told[0].startswith("the work of a process pool, processes ")
