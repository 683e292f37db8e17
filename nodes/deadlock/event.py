"""A goal that waits for an event, which only a timer in the same group sets."""

from __future__ import annotations

import asyncio
from typing import Any

import graphflow
from graphflow import ActionClient, Group, Node, action, task, timer
from graphflow.msgs.example_interfaces.action import Fibonacci


class Patient(Node):
    """Accept goals that wait for a timer, which cannot run meanwhile."""

    everything = Group(1)
    goals = ActionClient(Fibonacci, "~/wait")

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.time_has_come = asyncio.Event()
        self.ticks = 0

    @action(Fibonacci, "~/wait", group=everything)
    async def execute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.time_has_come.wait()
        return Fibonacci.Result(sequence=[self.ticks])

    @timer(0.5, group=everything)
    async def tick(self) -> None:
        self.ticks += 1
        if self.ticks >= 4:
            self.time_has_come.set()

    @task
    async def ask(self) -> None:
        async with self.goals.send(Fibonacci.Goal(order=1)) as goal:
            self.log.info("after %d ticks", (await goal.result()).sequence[0])


if __name__ == "__main__":
    graphflow.run(Patient)
