"""Errors of tasks that are kept and never awaited."""

from __future__ import annotations

import asyncio
import gc
import logging
from typing import Any

import pytest

from graphflow.errors import ClosedError
from graphflow.runtime.mistakes.errors.kept_errors import KeptErrors

Caplog = pytest.LogCaptureFixture


async def fail(error: Exception) -> None:
    raise error


def told(caplog: Caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.ERROR]


async def test_it_is_told_at_the_second_look(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """Once, and not again when the task is freed; until then, somebody may be about to await it."""
    watch = KeptErrors(asyncio.get_running_loop())
    kept = asyncio.create_task(fail(ValueError("boom")))
    await asyncio.sleep(0)
    watch.look()
    assert told(caplog) == []
    watch.look()
    watch.look()
    [text] = told(caplog)
    assert text.startswith("fail failed, and nothing awaits it (await it, or start it with self.spawn(...)")
    assert text.endswith(": ValueError: boom")
    del kept
    gc.collect()
    assert len(told(caplog)) == 1


async def test_tasks_that_are_no_loss(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """They were awaited, cancelled, or belong to a node that has stopped, or to a library; or they run on."""
    watch = KeptErrors(asyncio.get_running_loop())
    space: dict[str, Any] = {}
    exec(compile("async def work():\n    raise ValueError('boom')", "/x/site-packages/lib.py", "exec"), space)
    installed = asyncio.create_task(space["work"]())
    library = asyncio.create_task(asyncio.wait_for(fail(ValueError("boom")), 1.0))
    tasks = [asyncio.create_task(fail(error)) for error in (ValueError("boom"), ClosedError("the node has stopped"))]
    cancelled, runs = (asyncio.create_task(asyncio.sleep(10.0)) for _ in range(2))
    cancelled.cancel()
    await asyncio.wait([installed, library, *tasks, cancelled], timeout=5.0)
    with pytest.raises(ValueError, match="boom"):
        await tasks[0]
    watch.look()
    watch.look()
    assert told(caplog) == []
    runs.cancel()
    for task in (library, installed):
        with pytest.raises(ValueError, match="boom"):
            await task
