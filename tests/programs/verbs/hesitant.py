"""An action server that takes its time to accept a goal, and says when it begins one."""

from __future__ import annotations

from graphflow import Node, action
from graphflow.msgs.example_interfaces.action import Fibonacci


class Hesitant(Node):
    async def on_start(self) -> None:
        self.log.info("starts")

    async def ponder(self, goal: Fibonacci.Goal) -> bool:
        self.log.info("ponders %d", goal.order)
        await self.clock.sleep(goal.order / 10)
        return True

    @action(Fibonacci, "compute", accept=ponder)
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        self.log.info("begins %d", goal.request.order)
        return Fibonacci.Result()
