"""Two nodes that ask each other, each while it holds the slot in which it could answer: neither alone is wrong."""

from __future__ import annotations

import graphflow
from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Neighbour(Node):
    """Asks the other one, once a second, whether it is well."""

    default_group = Group(1)
    other = Client(Trigger, "other")

    @timer(1.0)
    async def greet(self) -> None:
        await self.clock.sleep(0.1)  # so that both are at it together
        response = await self.other.call(Trigger.Request())
        self.log.info("the other one says: %s", response.message)

    @service(Trigger, "~/how_are_you")
    async def how_are_you(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True, message="well")


if __name__ == "__main__":
    graphflow.run(Neighbour)
