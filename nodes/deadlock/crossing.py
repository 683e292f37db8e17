"""Two nodes that call each other while occupying the slot of their own service: neither alone is wrong."""

from __future__ import annotations

import graphflow
from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Neighbour(Node):
    """Call the other node once a second."""

    default_group = Group(1)
    other = Client(Trigger, "other")

    @timer(1.0)
    async def greet(self) -> None:
        await self.clock.sleep(0.6)  # more than half a period, so that both have a handler running when they call
        response = await self.other.call(Trigger.Request())
        self.log.info("the other one says: %s", response.message)

    @service(Trigger, "~/how_are_you")
    async def how_are_you(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True, message="well")


if __name__ == "__main__":
    graphflow.run(Neighbour)
