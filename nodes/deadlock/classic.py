"""ROS 2's classic deadlock: the response of another node's service needs a slot of the group that waits for it.

In ROS 2 a client belongs to a group like everything else, so this happens by default. In graphflow, responses need no
slot unless the client is in a group, as here.
"""

from __future__ import annotations

import graphflow
from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts


class Adder(Node):
    """Add two numbers."""

    @service(AddTwoInts, "add_two_ints")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)


class Asker(Node):
    """Occupy the group's only slot while the response waits for it."""

    everything = Group(1)
    adder = Client(AddTwoInts, "add_two_ints", group=everything)

    @timer(1.0, group=everything)
    async def tick(self) -> None:
        response = await self.adder.call(AddTwoInts.Request(a=1, b=2))
        self.log.info("1 + 2 = %d", response.sum)


if __name__ == "__main__":
    graphflow.run(Asker)
