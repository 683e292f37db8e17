"""Errors of tasks that are never awaited."""

from __future__ import annotations

import asyncio
import gc
import logging

import pytest

from graphflow.errors import ClosedError
from graphflow.runtime.mistakes.errors import lost_errors
from graphflow.runtime.mistakes.errors.lost_errors import log_lost_errors


async def fail(error: Exception) -> None:
    raise error


async def lose(error: Exception, times: int = 1) -> None:
    """Start tasks that fail and are never awaited."""
    for _ in range(times):
        task = asyncio.create_task(fail(error))
        await asyncio.wait([task])
        del task
        gc.collect(0)


async def test_they_are_told(graphflow_runner: asyncio.Runner, caplog: pytest.LogCaptureFixture) -> None:
    """In the log's format with the task's name, the first, tenth and hundredth time."""
    loop = asyncio.get_running_loop()
    log_lost_errors(loop)
    try:
        await lose(ValueError("boom"), 12)
        await lose(ClosedError("the node has stopped"))
        cancelled = {"exception": asyncio.CancelledError(), "future": loop.create_future()}
        loop.call_exception_handler({"message": "_GatheringFuture exception was never retrieved", **cancelled})
        loop.call_exception_handler({"message": "something else"})
        loop.call_exception_handler(
            {"message": "a callback failed", "exception": ValueError("boom"), "future": loop.create_future()}
        )
    finally:
        loop.set_exception_handler(None)
    first, second, other, callback = [r.message for r in caplog.records if r.levelno >= logging.ERROR]
    assert first.startswith("fail failed, and nothing awaits it (await it, or start it with self.spawn(...)")
    assert first.endswith(": ValueError: boom")
    assert second.startswith("fail failed, and nothing awaits it, 10 times by now")
    assert other == "something else"
    assert callback.startswith("a callback failed")


async def test_a_callback_of_the_loop(graphflow_runner: asyncio.Runner, caplog: pytest.LogCaptureFixture) -> None:
    """Its error is told in the same way, and as seldom."""
    loop = asyncio.get_running_loop()
    log_lost_errors(loop)

    def call() -> None:
        raise ValueError("boom")

    try:
        for _ in range(12):
            loop.call_soon(call)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
    finally:
        loop.set_exception_handler(None)
    first, tenth = [record.getMessage() for record in caplog.records if record.levelno >= logging.ERROR]
    assert first == "a callback of the event loop failed: ValueError: boom"
    assert tenth == "a callback of the event loop failed, 10 times by now: ValueError: boom"


async def test_many_kinds_of_errors(graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only so many are counted."""
    monkeypatch.setattr(lost_errors, "PLACES_BOUND", 2)
    loop = asyncio.get_running_loop()
    log_lost_errors(loop)
    handler = loop.get_exception_handler()
    assert isinstance(handler, lost_errors._LostErrors)
    try:
        for error in (ValueError(), TypeError(), KeyError(), OSError(), IndexError()):
            await lose(error)
            assert 0 < len(handler._times) <= 2
    finally:
        loop.set_exception_handler(None)


async def test_a_handler_of_the_programs_own(graphflow_runner: asyncio.Runner) -> None:
    """It stays."""
    loop = asyncio.get_running_loop()
    told = list[str]()
    loop.set_exception_handler(lambda _, context: told.append(context["message"]))
    log_lost_errors(loop)
    try:
        await lose(ValueError("boom"))
    finally:
        loop.set_exception_handler(None)
    assert told == ["Task exception was never retrieved"]
