"""The tasks below an activity, with the limits of those above them."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

from graphflow.deadlock.wait_paths import Subtask, gathered, subtasks
from graphflow.testing.clock import settle


async def test_what_an_activity_waits_for(graphflow_runner: asyncio.Runner) -> None:
    """All tasks of a gather, a group or a shield, and theirs in turn; each once, and none that has ended."""
    sleeping = asyncio.create_task(asyncio.sleep(60))
    done = asyncio.create_task(asyncio.sleep(0))

    async def below() -> None:
        await asyncio.shield(sleeping)

    async def above() -> None:
        await asyncio.gather(inner, sleeping, done, asyncio.get_running_loop().create_future())

    inner = asyncio.create_task(below())
    outer = asyncio.create_task(above())
    await settle()

    def limit_of(task: Any) -> int | None:
        return {outer: 7, inner: 9}.get(task)

    found = {one.task: one for one in subtasks(outer, limit_of)}
    assert found == {inner: Subtask(inner, 7, True), sleeping: Subtask(sleeping, 7, True)}
    assert not any(one.is_bounded for one in subtasks(outer, lambda _: None))
    outer.cancel()
    await asyncio.wait([outer])


async def test_the_parts_of_a_gather(graphflow_runner: asyncio.Runner) -> None:
    """Those of one method; unless one has failed, and the others go on without it."""
    failing = asyncio.get_running_loop().create_future()

    async def part() -> None:
        await asyncio.sleep(60)

    async def fail() -> None:
        await failing

    async def above() -> None:
        with suppress(ValueError):
            await asyncio.gather(part(), part(), fail())
        await asyncio.sleep(60)

    outer, loop = asyncio.create_task(above()), asyncio.get_running_loop()
    await settle()
    found = gathered({"part"}, [outer], lambda _: None, loop)
    assert found is not None
    assert len(found) == 2
    failing.set_exception(ValueError())
    await settle()
    assert gathered({"part"}, [outer], lambda _: None, loop) is None
    tasks = [outer, *(below.task for below in found if isinstance(below.task, asyncio.Task))]
    for task in tasks:
        task.cancel()
    await asyncio.wait(tasks)
