"""How a program that runs nodes is ended."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest

from graphflow.runtime import ending
from graphflow.runtime.ending import _stop_signals, catch_signals
from graphflow.runtime.stop_limit import StopLimit
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
    started: list[int] = []

    def start(limit: StopLimit, number: int) -> None:
        limit.is_started = True
        started.append(number)
        if len(started) == 1:
            signal.raise_signal(signal.SIGTERM)

    async def be_asked() -> None:
        restore = catch_signals(stop := asyncio.Event())
        try:
            signal.raise_signal(signal.SIGTERM)
            await asyncio.wait_for(stop.wait(), 5.0)
        finally:
            restore()

    monkeypatch.setattr(StopLimit, "start", start)
    asyncio.run(be_asked())
    assert len(started) == 1


def vendors_handler(*_: object) -> None:
    """A handler that a library may install."""


async def test_who_takes_a_signal_by_the_loop_is_named(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It is the callback, and not the loop's own handler."""
    monkeypatch.setattr(ending, "CHECK_AFTER", 0.0)
    restore, loop = catch_signals(asyncio.Event()), asyncio.get_running_loop()
    try:
        loop.add_signal_handler(signal.SIGTERM, vendors_handler)
        for _ in range(5):
            await asyncio.sleep(0)
    finally:
        loop.remove_signal_handler(signal.SIGTERM)
        restore()
    [record] = caplog.records
    assert record.getMessage().startswith("loop.add_signal_handler, which calls <Handle vendors_handler() at ")


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
