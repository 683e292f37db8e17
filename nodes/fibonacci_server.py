"""The action server of every ROS 2 tutorial: a goal that takes its time, feedback on the way, and a result.

Cancelling needs no code here. A goal that is cancelled gets `CancelledError` at its next `await`, and its client gets
what `goal.partial` held.
"""

import graphflow
from graphflow import Group, Node, action
from graphflow.msgs.example_interfaces.action import Fibonacci


class FibonacciServer(Node):
    """Count like rabbits, one generation a second."""

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
