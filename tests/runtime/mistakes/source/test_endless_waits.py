"""Waits for what nothing ends."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from graphflow.analysis.syntax import syntax_of
from graphflow.runtime.mistakes.source.endless_waits import endless_waits
from graphflow.runtime.mistakes.source.shadowing import definition_of

HEAD = """\
import asyncio
from graphflow import Node, subscription, timer
from graphflow.msgs.std_msgs.msg import String

class Robot(Node):
    pose = None

    def __init__(self):
        super().__init__("robot")
        self.ready, self.there = asyncio.Event(), False
        self.event = asyncio.Event()
        self.queue = asyncio.Queue()
        self.lock = asyncio.Lock()
        self.done = False

    @timer(1.0)
    async def go(self):
        {wait}
        self.log.info("go")

    @subscription(String, "heard")
    async def heard(self, message):
        {other}

{more}
"""

Told = Callable[..., list[str]]


@pytest.fixture
def told(tmp_path: Path) -> Iterator[Told]:
    """Returns the sentences about the class `Robot` of a module with these lines."""

    def found(wait: str, other: str = "pass", more: str = "") -> list[str]:
        syntax_of.cache_clear()
        file = tmp_path / "endless_module.py"
        file.write_text(HEAD.format(wait=wait, other=other, more=more))
        spec = importlib.util.spec_from_file_location("endless_module", file)
        assert spec is not None
        assert spec.loader is not None
        sys.modules["endless_module"] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        source = definition_of(module.Robot)
        assert source is not None
        return [text for _, _, text in endless_waits(module.Robot, source[0], syntax_of(str(file)).module)]

    yield found
    sys.modules.pop("endless_module", None)


@pytest.mark.parametrize(
    ("wait", "text"),
    [
        ("await self.event.wait()", "nothing sets it; call self.event.set() in another handler"),
        ("print(await self.queue.get())", "nothing puts anything into it; call self.queue.put(...) in another"),
        ("await self.lock.acquire()", "nothing releases it; call self.lock.release() in another handler"),
        ("while self.pose is None: await self.clock.sleep(0.1)", "nothing in Robot sets it to anything but None"),
        ("while not self.done: await self.clock.sleep(0.1)", "nothing in Robot sets it to anything but False"),
    ],
)
def test_waits_without_an_end(told: Told, wait: str, text: str) -> None:
    """Each is told with the call that would end it."""
    [found] = told(wait)
    assert text in found


@pytest.mark.parametrize(
    ("wait", "other", "more"),
    [
        ("await self.event.wait()", "self.event.set()", ""),
        ("await self.event.wait()", "keep(self.event)", "def keep(event): event.set()"),
        ("await self.event.wait()", "pass", "def end(robot): robot.event.set()"),
        ("await self.event.wait()", "pass", "class Sub(Robot):\n    def f(self): self.event.set()"),
        ("await asyncio.wait_for(self.event.wait(), 1.0)", "pass", ""),
        ("async with self.clock.timeout(1.0): await self.event.wait()", "pass", ""),
        ("print(await self.queue.get())", "self.queue.put_nowait(message)", ""),
        ("async with self.lock: pass", "pass", ""),
        ("await self.lock.acquire()", "self.lock.release()", ""),
        ("while self.pose is None: await self.clock.sleep(0.1)", "self.pose = message", ""),
        ("while self.pose is None: await self.clock.sleep(0.1)", "setattr(self, 'pose', message)", ""),
        ("while not self.done: await self.clock.sleep(0.1)", "self.done = True", ""),
        ("while not self.done: await self.clock.sleep(0.1)", "self.done |= True", ""),
        ("while not self.done: await self.clock.sleep(0.1)", "pass", "def end(robot): robot.done = True"),
        ("while not self.done:\n            if self.there: break\n            await self.clock.sleep(0.1)", "pass", ""),
    ],
)
def test_waits_that_may_end(told: Told, wait: str, other: str, more: str) -> None:
    """By another method, by code that the object is given to, by a subclass, a deadline, or a `break`."""
    assert told(wait, other, more) == []
