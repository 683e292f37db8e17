"""Actions in threads that never look whether they are cancelled."""

from __future__ import annotations

import ast
import inspect
import textwrap
import time
from typing import Any

from graphflow import Node, action
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.runtime.mistakes.source.uncancelled import uncancelled


def count(goal: Any) -> None:
    """Count, and look at the goal."""


class Counter(Node):
    """Four actions, of which the first cannot be cancelled."""

    @action(Fibonacci, "deaf", thread=True)
    def deaf(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        """Count on."""
        for _ in range(3):
            time.sleep(1.0)
        return Fibonacci.Result()

    @action(Fibonacci, "polite", thread=True)
    def polite(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        """Look at the goal."""
        while not goal.is_cancel_requested:
            time.sleep(1.0)
        return Fibonacci.Result()

    @action(Fibonacci, "other", thread=True)
    def other(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        """Let another function look at it."""
        for _ in range(3):
            count(goal)
        return Fibonacci.Result()

    @action(Fibonacci, "native")
    async def native(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        """Be interrupted at an await."""
        for _ in range(3):
            await self.clock.sleep(1.0)
        return Fibonacci.Result()


def test_a_deaf_thread() -> None:
    """It is told with the line of its loop, and what to write there."""
    [definition] = ast.parse(textwrap.dedent(inspect.getsource(Counter))).body
    assert isinstance(definition, ast.ClassDef)
    [(line, text)] = uncancelled(Counter, definition)
    assert line == 7
    assert text == (
        "cancelling does not end deaf, since it runs in a thread: in the loop write if goal.is_cancel_requested: "
        "return Fibonacci.Result()"
    )
