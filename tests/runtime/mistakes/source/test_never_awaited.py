"""Calls of coroutine functions as statements, without `await`."""

from __future__ import annotations

import ast
import asyncio
from collections.abc import Callable

import pytest

from graphflow import ActionClient, Client, Node, Publisher, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.source.never_awaited import never_awaited

NOTHING = "does nothing, since {} is a coroutine function; write await before it, in an async def"


async def settle() -> None:
    """Wait a moment."""


def scheduled(fn: Callable[..., object]) -> Callable[..., None]:
    """Make an `async def` that starts a task when it is called."""

    def call(*_: object) -> None: ...

    return call


class Base(Node):
    out = Publisher(String, "out")
    adder = Client(AddTwoInts, "add")
    counter = ActionClient(Fibonacci, "count")

    async def drive(self) -> None: ...

    def steer(self) -> None: ...

    @scheduled
    async def later(self) -> None: ...


class Robot(Base):
    @timer(1.0)
    async def tick(self) -> None: ...


def _told(line: str) -> list[tuple[int, str]]:
    definition = ast.parse(f"class Robot(Base):\n    async def go(self, given=None):\n        {line}").body[0]
    assert isinstance(definition, ast.ClassDef)
    return list(never_awaited(Robot, Robot, definition, globals()))


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("self.clock.sleep(1.0)", "Clock.sleep"),
        ("asyncio.sleep(1.0)", "sleep"),
        ("settle()", "settle"),
        ("self.tick()", "Robot.tick"),
        ("self.drive()", "Base.drive"),
        ("super().drive()", "Base.drive"),
        ("self.offload(print)", "Node.offload"),
        ("self.adder.call(request)", "ServiceClient.call"),
        ("self.counter.send_goal(goal)", "GoalClient.send_goal"),
        ("self.out.wait_matched()", "Endpoint.wait_matched"),
    ],
)
def test_coroutines_that_nothing_awaits(line: str, name: str) -> None:
    """Are found with their lines, whichever code has the function."""
    assert _told(line) == [(3, f"`{line}` {NOTHING.format(name)}")]


@pytest.mark.parametrize("kept", ["self.goal", "sent"])
def test_coroutines_that_are_kept(kept: str) -> None:
    """Nothing awaits them, even if it asks them for a result as it would a future."""
    told = [(3, f"`self.counter.send_goal(goal)` {NOTHING.format('GoalClient.send_goal')}")]
    assert _told(f"{kept} = self.counter.send_goal(goal)") == told
    assert _told(f"{kept} = self.counter.send_goal(goal); print({kept}.result())") == told


@pytest.mark.parametrize(
    "line",
    [
        "await self.clock.sleep(1.0)",
        "task = self.drive(); await task",
        "task = self.drive(); asyncio.create_task(task)",
        "task = self.drive(); return task",
        "self.kept = self.drive(); await self.kept",
        "self.kept = other = self.drive()",
        "self.all[0] = self.drive()",
        "given.kept = self.drive()",
        "self.spawn(self.drive)",
        "self.steer()",
        "super().steer()",
        "self.later()",
        "self.out.publish(String())",
        "self.shutdown()",
        "self.log.info('on')",
        "given()",
        "given.sleep(1.0)",
        "settle = print; settle()",
        "asyncio.create_task(self.drive())",
        "self.missing()",
        "self.drive = print; self.drive()",
        "async for n in self.clock.every(1.0): ...",
    ],
)
def test_whatever_runs_or_is_unknown(line: str) -> None:
    """Is not reported."""
    assert _told(line) == []
    assert asyncio.iscoroutinefunction(settle)
