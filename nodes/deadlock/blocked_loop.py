"""A handler that waits for a response without `await`: it blocks the event loop, which would have to receive it."""

from __future__ import annotations

import graphflow
from graphflow import Client, Node, service, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts


class Blocker(Node):
    """Call a service synchronously, as in a script."""

    adder = Client(AddTwoInts, "~/add")

    @timer(1.0)
    def tick(self) -> None:
        response = self.adder.call_sync(AddTwoInts.Request(a=1, b=2))
        self.log.info("1 + 2 = %d", response.sum)

    @service(AddTwoInts, "~/add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)


if __name__ == "__main__":
    graphflow.run(Blocker)
