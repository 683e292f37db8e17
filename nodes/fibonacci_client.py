"""An action client: a goal is a block, and leaving the block early cancels the goal."""

import graphflow
from graphflow import ActionClient, GoalError, Node, Param, task
from graphflow.msgs.example_interfaces.action import Fibonacci


class FibonacciClient(Node):
    """Request a sequence, log its growth, and give up after `patience` seconds."""

    order = Param(10, ge=0, doc="Where the sequence ends.")
    patience = Param(60.0, unit="s", gt=0.0, doc="How long to wait for it.")
    fibonacci = ActionClient(Fibonacci, "fibonacci")

    @task
    async def ask(self) -> None:
        await self.fibonacci.wait_ready()
        async with self.fibonacci.send(Fibonacci.Goal(order=self.order)) as goal:
            try:
                async with self.clock.timeout(self.patience):
                    async for feedback in goal.feedback():
                        self.log.info("Received feedback: %s", feedback.sequence.tolist())
            except TimeoutError:
                self.log.info("This takes too long.")
        try:
            self.log.info("Result: %s", (await goal.result()).sequence.tolist())
        except GoalError as error:
            self.log.info("No result: %s", error)
        self.shutdown()


if __name__ == "__main__":
    graphflow.run(FibonacciClient)
