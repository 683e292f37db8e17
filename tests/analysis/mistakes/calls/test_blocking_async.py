"""Lines that stop an event loop."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.blocking_async import blocking_async


def told(body: str, head: str = "async def tick(self)") -> list[tuple[int, str]]:
    lines = "".join(f"        {line}\n" for line in body.splitlines())
    return list(blocking_async(ast.parse(f"class Walker(Node):\n    {head}:\n{lines}")))


@pytest.mark.parametrize("pause", ["1 / self.rate", "0.05", "1"])
def test_a_sleep(pause: str) -> None:
    """It comes with the one that is awaited."""
    [(line, text)] = told(f"time.sleep({pause})")
    assert line == 3
    assert text == (
        f"time.sleep in an async def stops every handler of the process; write await self.clock.sleep({pause})"
    )


@pytest.mark.parametrize("call", ["self.clock.sleep(0.5)", "asyncio.sleep(1)"])
def test_a_loop_whose_pause_is_not_awaited(call: str) -> None:
    """The pause is told, and not that the loop lacks one."""
    [(line, text)] = told(f"while True:\n    self.out.publish(Twist())\n    {call}")
    assert line == 5
    assert text == f"{call} without await does not pause, and this loop blocks the process; write await {call}"
    assert told(f"while True:\n    {call}\n    await self.other.call(request)") == []


def test_a_loop_with_a_blocking_pause() -> None:
    """The pause alone is told, since its remedy is that of the loop."""
    [(line, text)] = told("while True:\n    self.out.publish(Twist())\n    time.sleep(1.0)")
    assert line == 5
    assert text.endswith("write await self.clock.sleep(1.0)")


@pytest.mark.parametrize("condition", ["True", "1"])
def test_a_loop_without_a_pause(condition: str) -> None:
    """Its line is told, whatever it calls."""
    [(line, text)] = told(f"while {condition}:\n    self.out.publish(Twist())")
    assert line == 3
    assert text == (
        "this loop never awaits, so no other handler of the process runs; end each turn with "
        "await self.clock.sleep(0.1), or write @timer(0.1) in place of the loop"
    )


def test_a_loop_in_a_timer() -> None:
    """The timer is one already."""
    module = ast.parse("@timer(0.1)\nasync def tick(self):\n    while True:\n        self.out.publish(Twist())\n")
    [(line, text)] = blocking_async(module)
    assert line == 3
    assert text.endswith("; leave out the loop: the timer repeats what is in it")


@pytest.mark.parametrize("pause", ["pass", "await self.clock.sleep(0.1)"])
def test_a_loop_that_reads_lines(pause: str) -> None:
    """Whether it pauses or not: nothing runs until a line comes."""
    [(line, text)] = told(f"while True:\n    line = input('> ')\n    {pause}")
    assert line == 4
    assert text == (
        "input() in an async def stops every handler of the process until a line comes; "
        "write await self.offload(input, '> ')"
    )
    assert told("while True:\n    line = await self.offload(input, '> ')") == []


def test_a_pause_of_another_function() -> None:
    """It is none of the loop's."""
    [(line, _)] = told("while True:\n    def work():\n        return 1\n    self.use(work)")
    assert line == 3


@pytest.mark.parametrize(
    "body",
    [
        "await self.clock.sleep(1.0)",
        "time.sleep(0.001)",
        "await asyncio.to_thread(lambda: time.sleep(1.0))",
        "def work():\n    time.sleep(1.0)\nawait self.offload(work)",
    ],
)
def test_sleeps_that_let_others_run(body: str) -> None:
    """Awaited ones, short ones, and those of threads."""
    assert told(body) == []


@pytest.mark.parametrize(
    "line",
    [
        "await self.clock.sleep(0.1)",
        "async for message in self.heard: self.use(message)",
        "found = [message async for message in self.heard]",
        "async with self.lock: self.step()",
        "yield self.read()",
        "if self.read(): break",
        "if self.read(): return",
        "if self.read(): raise ValueError",
    ],
)
def test_loops_that_let_others_run(line: str) -> None:
    """Loops that wait or end are left alone."""
    assert told(f"while True:\n    {line}") == []


def test_a_loop_with_a_condition() -> None:
    """The calls in a loop may change its condition."""
    assert told("while self.is_on:\n    self.step()") == []


def test_a_handler_in_a_thread() -> None:
    """A `def` may sleep."""
    assert told("time.sleep(1.0)", "def tick(self)") == []
