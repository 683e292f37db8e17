"""Lines that stop an event loop."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.blocking_async import blocking_async


def told(body: str, head: str = "async def tick(self)") -> list[tuple[int, str]]:
    lines = "".join(f"        {line}\n" for line in body.splitlines())
    return list(blocking_async(ast.parse(f"class Walker(Node):\n    {head}:\n{lines}")))


def test_a_sleep() -> None:
    """It comes with the one that is awaited."""
    [(line, text)] = told("time.sleep(1 / self.rate)")
    assert line == 3
    assert text == (
        "time.sleep in an async def stops every handler of the process; write await self.clock.sleep(1 / self.rate)"
    )


def test_a_loop_without_a_pause() -> None:
    """Its line is told, whatever it calls."""
    [(line, text)] = told("while True:\n    self.out.publish(Twist())")
    assert line == 3
    assert text.startswith("this loop never awaits, so no other handler of the process runs")


@pytest.mark.parametrize(
    "body",
    [
        "await self.clock.sleep(1.0)",
        "time.sleep(0.001)",
        "await asyncio.to_thread(lambda: time.sleep(1.0))",
        "def work():\n    time.sleep(1.0)\nawait self.offload(work)",
        "while True:\n    await self.clock.sleep(0.1)",
        "while True:\n    if self.read():\n        break",
        "while self.is_on:\n    self.step()",
    ],
)
def test_what_lets_others_run(body: str) -> None:
    """Awaited sleeps, short ones, those of threads, and loops that end."""
    assert told(body) == []


def test_a_handler_in_a_thread() -> None:
    """A `def` may sleep."""
    assert told("time.sleep(1.0)", "def tick(self)") == []
