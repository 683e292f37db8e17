"""A service that calls itself: a group with two slots allows a depth of two."""

from __future__ import annotations

import graphflow
from graphflow import Client, Group, Node, Param, service, task
from graphflow.msgs.example_interfaces.srv import AddTwoInts


class Factorial(Node):
    """Compute a factorial by calling itself for the number below."""

    depth = Param(3, ge=0, doc="The number whose factorial is wanted.")
    answers = Group(2)
    itself = Client(AddTwoInts, "~/factorial")

    @service(AddTwoInts, "~/factorial", group=answers)
    async def factorial(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        if request.a <= 1:
            return AddTwoInts.Response(sum=1)
        smaller = await self.itself.call(AddTwoInts.Request(a=request.a - 1))
        return AddTwoInts.Response(sum=request.a * smaller.sum)

    @task
    async def ask(self) -> None:
        response = await self.itself.call(AddTwoInts.Request(a=self.depth))
        self.log.info("%d! = %d", self.depth, response.sum)


if __name__ == "__main__":
    graphflow.run(Factorial)
