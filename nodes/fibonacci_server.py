"""The action server of the ROS 2 tutorials: a goal that takes time, with feedback and a result.

Cancellation needs no code here. A cancelled goal raises `CancelledError` at its next `await`, and its client receives
`goal.partial`.
"""

import graphflow
from graphflow import Group, Node, action
from graphflow.msgs.example_interfaces.action import Fibonacci


class FibonacciServer(Node):
    """Compute Fibonacci numbers, one a second."""

    goals = Group(limit=None)

    def can_count(self, goal: Fibonacci.Goal) -> bool | str:
        return 0 <= goal.order <= 46 or "an int32 holds no more than 46 generations"

    @action(Fibonacci, "fibonacci", group=goals, policy="parallel", accept=can_count)
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        self.log.info("Executing goal...")
        sequence = [0, 1]
        while len(sequence) <= goal.request.order:
            await self.clock.sleep(1.0)
            sequence.append(sequence[-1] + sequence[-2])
            goal.feedback(Fibonacci.Feedback(sequence=sequence))
            goal.partial = Fibonacci.Result(sequence=sequence)
        return Fibonacci.Result(sequence=sequence)


if __name__ == "__main__":
    graphflow.run(FibonacciServer)
