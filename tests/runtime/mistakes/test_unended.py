"""Handlers and tasks that go on although they were cancelled."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

import pytest

from graphflow.runtime.mistakes.unended import unended


class Work:
    """Goes on in several ways; each ends when `over` is set."""

    def __init__(self) -> None:
        self.over = asyncio.Event()

    async def catches_all(self) -> None:
        while not self.over.is_set():
            try:
                await self.over.wait()
            except:  # noqa: E722
                pass

    async def inside(self) -> None:
        await self.catches_all()

    async def catches_others(self) -> None:
        while not self.over.is_set():
            try:
                await self.over.wait()
            except Exception:
                continue
            finally:
                await self.over.wait()

    async def leaves_the_loop(self) -> None:
        while True:
            try:
                await asyncio.sleep(100.0)
            except asyncio.CancelledError:
                break
        await self.over.wait()

    async def waits_for_its_child(self) -> None:
        try:
            await asyncio.sleep(100.0)
        finally:
            with suppress(asyncio.CancelledError):
                await self.over.wait()


async def _told(name: str) -> str:
    work = Work()
    task: asyncio.Task[Any] = asyncio.ensure_future(getattr(work, name)())
    await asyncio.sleep(0)
    task.cancel()
    for _ in range(3):
        await asyncio.sleep(0)
    assert not task.done()
    said = unended([task], {task: "/n.work"}, [])
    work.over.set()
    with suppress(asyncio.CancelledError):
        await task
    return said


@pytest.mark.parametrize("name", ["catches_all", "inside"])
def test_a_loop_that_catches_everything(name: str) -> None:
    """Is named with its line and the remedy."""
    line = Work.catches_all.__code__.co_firstlineno + 4
    assert asyncio.run(_told(name)) == (
        f"/n.work; CancelledError is caught in test_unended.py:{line}: write except Exception, or raise it again"
    )


@pytest.mark.parametrize("name", ["catches_others", "leaves_the_loop", "waits_for_its_child"])
def test_a_long_cleanup(name: str) -> None:
    """Is named without a line: nothing keeps it from ending."""
    assert asyncio.run(_told(name)) == "/n.work"
