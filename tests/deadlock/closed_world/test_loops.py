"""Loops and frames of code that waits: which loops poll, where they pause, and which functions only let time pass."""

from __future__ import annotations

import ast
import sys
from types import FrameType

import pytest

from graphflow.analysis.class_source import Function
from graphflow.analysis.frames import Frame, running
from graphflow.analysis.syntax import FunctionNode
from graphflow.deadlock.closed_world.loops import Loop, Spot, is_library, may_poll, only_pauses, pause_of


def here() -> Frame:
    """The caller's frame."""
    caller: FrameType | None = sys._getframe().f_back
    assert caller is not None
    return running(caller)


sleep = here
"""By a name that lets time pass."""


class Rate:
    """A rate made by hand."""

    def __init__(self) -> None:
        self.turns = 0
        self.frames: list[Frame] = []

    def pause(self) -> Frame:
        self.turns += max(1, 0)
        return sleep()

    def work(self) -> Frame:
        self.frames.append(sleep())
        return self.frames[-1]


def loop_of(text: str) -> Loop:
    [loop] = [node for node in ast.walk(ast.parse(text)) if isinstance(node, Loop)]
    return loop


@pytest.mark.parametrize(
    ("text", "polls"),
    [
        ("while not self.ready: pass", True),
        ("for x in y: pass", False),
        ("async def f():\n async for _ in self.clock.every(1.0): pass", True),
        ("async def f():\n async for _ in self.goals: pass", False),
    ],
)
def test_loops_that_poll(text: str, polls: bool) -> None:
    """Such a loop ends by its condition alone."""
    assert may_poll(loop_of(text)) is polls


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("while x:\n  sleep(1)", 2),
        ("while x:\n  a()\n  await asyncio.sleep(1)", 3),
        ("while x:\n  a()", 0),
        ("while x:\n  sleep(1)\n  sleep(2)", 0),
    ],
)
def test_the_line_of_a_pause(text: str, line: int) -> None:
    """It is known if there is only one."""
    found = pause_of(loop_of(f"async def f():\n {text.replace(chr(10), chr(10) + ' ')}"), here())
    assert (0 if found is None else found.line - 1) == line


def test_functions_that_only_let_time_pass() -> None:
    """They may count; but calls of other functions are work."""
    rate = Rate()
    assert only_pauses(rate.pause())
    assert not only_pauses(rate.work())


def test_code_of_libraries() -> None:
    """asyncio's is, a test's is not."""
    assert not is_library(here())


def test_loops_around_a_line() -> None:
    """The outermost first."""
    module = ast.parse("def f():\n while a:\n  for b in c:\n   d()\n while e: pass\n")
    [function] = module.body
    assert isinstance(function, FunctionNode)
    frame = here()
    spot = Spot(Frame(frame.f_code, 4, {}, {}, frame.original), Function(function, "f"))
    assert [loop.lineno for loop in spot.loops] == [2, 3]
