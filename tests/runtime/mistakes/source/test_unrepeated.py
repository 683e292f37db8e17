"""Tasks written as the body of a loop."""

from __future__ import annotations

import ast
import asyncio
import inspect
import textwrap

from graphflow import Node, Publisher, task
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.source.unrepeated import unrepeated


class Driver(Node):
    """Three tasks, of which the first should be a timer."""

    out = Publisher(String, "chatter")

    @task
    async def drive(self) -> None:
        """Publish and wait."""
        self.out.publish(String())
        await self.clock.sleep(0.5)

    @task
    async def repeat(self) -> None:
        """Publish again and again."""
        while True:
            self.out.publish(String())
            await self.clock.sleep(0.5)

    @task
    async def later(self) -> None:
        """Wait and publish."""
        await asyncio.sleep(0.5)
        self.out.publish(String())


def test_a_task_that_ends_with_a_sleep() -> None:
    """It is told what repeats; a loop and a task that goes on after the sleep are left alone."""
    [definition] = ast.parse(textwrap.dedent(inspect.getsource(Driver))).body
    assert isinstance(definition, ast.ClassDef)
    [(line, text)] = unrepeated(Driver, definition)
    assert line == 10
    assert text == (
        "drive runs once, and ends after this sleep; write @timer(0.5) above it in place of @task, without the sleep, "
        "or put its lines into while True:"
    )
