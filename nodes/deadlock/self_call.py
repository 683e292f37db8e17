"""A node that calls its own service from a handler of the same group: a common first deadlock in ROS 2."""

from __future__ import annotations

import graphflow
from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts


class Narcissus(Node):
    """Call its own service once a second while occupying the service's only slot."""

    default_group = Group(1)
    adder = Client(AddTwoInts, "~/add")

    @timer(1.0)
    async def tick(self) -> None:
        response = await self.adder.call(AddTwoInts.Request(a=1, b=2))
        self.log.info("1 + 2 = %d", response.sum)

    @service(AddTwoInts, "~/add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)


if __name__ == "__main__":
    graphflow.run(Narcissus)
