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
import asyncio, threading
from graphflow import Node, Param, Subscription, subscription, task, timer
from graphflow.msgs.std_msgs.msg import String

class Robot(Node):
    pose = None
    is_on = Param(False)
    words = Subscription(String, "words")

    def __init__(self):
        super().__init__("robot")
        self.ready, self.there = asyncio.Event(), False
        self.event = asyncio.Event()
        self.queue = asyncio.Queue()
        self.lock = asyncio.Lock()
        self.gate = threading.Event()
        self.done = False
        self.answer = None
        self.items = asyncio.Queue(maxsize=1)

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
        ("while not self.pose: await self.clock.sleep(0.1)", "nothing in Robot sets it to anything but False"),
        (
            "self.answer = asyncio.get_running_loop().create_future(); await self.answer",
            "Robot waits for self.answer, and nothing ends it; call self.answer.set_result(...) in another handler",
        ),
        (
            "async for word in self.words: print(word)",
            "this loop never ends, so that the timer runs once: read self.words in a method with @task",
        ),
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
        ("await self.event.wait()", "Robot.first.event.set()", ""),
        ("await self.event.wait()", "self.event = Gate()", ""),
        ("await self.event.wait()", "self.event = message", ""),
        ("print(await self.queue.get())", "self.queue, self.size = make()", ""),
        (
            "await self.event.wait(); print(await self.queue.get()); await self.lock.acquire()",
            "self.event = Gate(); self.queue = Store(); self.lock = Latch()",
            "",
        ),
        ("await self.event.wait()", "pass", "def end(robot): robot.event.set()"),
        ("await self.event.wait()", "pass", "class Sub(Robot):\n    def f(self): self.event.set()"),
        ("print(await self.queue.get())", "self.queue.put_nowait(message)", ""),
        ("await self.lock.acquire()", "self.lock.release()", ""),
        ("self.answer = asyncio.Future(); await self.answer", "self.answer.set_result(1)", ""),
        ("self.answer = self.loop.create_future(); await self.answer", "self.answer.cancel()", ""),
        ("self.answer = self.loop.create_future(); await self.answer", "keep(self.answer)", "def keep(f): ..."),
        ("self.answer = self.work(); await self.answer", "pass", ""),
        ("async with self.lock: await self.answer", "self.answer = self.loop.create_future()", ""),
        ("async for word in self.words: break", "pass", ""),
        ("async for word in self.other: print(word)", "pass", ""),
    ],
)
def test_waits_that_may_end(told: Told, wait: str, other: str, more: str) -> None:
    """By another method, by code that the object is given to, by a subclass, or since another class makes it."""
    assert told(wait, other, more) == []


@pytest.mark.parametrize(
    "wait",
    [
        "await asyncio.wait_for(self.event.wait(), 1.0)",
        "async with self.clock.timeout(1.0): await self.event.wait()",
        "self.gate.wait(1.0)",
        "self.gate.wait(timeout=1.0)",
        "self.event.clear()",
        "async with self.lock: pass",
    ],
)
def test_what_takes_no_longer(told: Told, wait: str) -> None:
    """Waits with a limit, and other uses of such objects."""
    assert told(wait) == []


@pytest.mark.parametrize(
    ("flag", "other", "more"),
    [
        ("self.pose is None", "self.pose = message", ""),
        ("self.pose is None", "setattr(self, 'pose', message)", ""),
        ("not self.done", "self.done = True", ""),
        ("not self.done", "self.done |= True", ""),
        ("not self.done", "self.done = self.there = True", ""),
        ("not self.done", "Robot.first.done = True", ""),
        ("not self.done", "pass", "def end(robot): robot.done = True"),
        ("not self.is_on", "pass", ""),
    ],
)
def test_flags_that_may_change(told: Told, flag: str, other: str, more: str) -> None:
    """Another line sets it, whatever it is called there; or it is a parameter, which a tool sets."""
    assert told(f"while {flag}: await self.clock.sleep(0.1)", other, more) == []


@pytest.mark.parametrize("end", ["", "if self.done: break", "if self.done: return"])
def test_a_handler_that_handles_one_message(told: Told, end: str) -> None:
    """Its loop has no end; the timer's may be meant so."""
    loop = f"while True:\n            {end or 'pass'}\n            await self.clock.sleep(0.1)"
    text = (
        "this loop never ends, so that only one message is handled: let the handler return, and loop in a method with"
    )
    assert told("pass", loop) == ([] if end else [f"{text} @task"])
    assert told(loop, "self.done = True") == []


@pytest.mark.parametrize("end", ["break", "return", "raise TimeoutError"])
def test_loops_that_may_end(told: Told, end: str) -> None:
    """In another way than by their flag."""
    wait = f"while not self.done:\n            if self.there: {end}\n            await self.clock.sleep(0.1)"
    assert told(wait) == []


WORKER = """
    @task
    async def work(self):
        {}
"""


def test_a_worker_that_takes_one_item(told: Told) -> None:
    """Handlers go on to fill the queue, and one that is full keeps them waiting."""
    worker = WORKER.format("print(await self.items.get())")
    text = "this task takes one item of self.items and ends; for all of them, write while True: around it"
    assert told("await self.items.put(1)", more=worker) == [text]
    assert told("self.items.put_nowait(1)", more=worker) == [text]


@pytest.mark.parametrize(
    ("wait", "line", "other"),
    [
        ("await self.items.put(1)", "while True: print(await self.items.get())", "pass"),
        ("await self.items.put(1)", "print(await self.items.get())", "self.items.get_nowait()"),
        ("await self.items.put(1)", "print(await self.items.get())", "keep(self.items)"),
        ("pass", "await self.items.put(2); print(await self.items.get())", "pass"),
        ("await self.items.put(1)", "print(await self.items.get())", "self.items = Store()"),
    ],
)
def test_workers_that_take_all(told: Told, wait: str, line: str, other: str) -> None:
    """Or others do, or nothing fills the queue again."""
    assert told(wait, other, WORKER.format(line)) == []
