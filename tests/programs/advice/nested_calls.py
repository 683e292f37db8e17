"""Two nodes that ask each other, one of them four functions deep."""

from __future__ import annotations

from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Rocket(Node):
    default_group = Group(1)
    clearance = Client(Trigger, "/tower/clear")

    @timer(0.2)
    async def launch(self) -> None:
        await self.prepare()
        self.log.info("lift-off")

    async def prepare(self) -> None:
        await self.check_everything()

    async def check_everything(self) -> None:
        await self.ask_tower()

    async def ask_tower(self) -> None:
        await self.clearance.call(Trigger.Request())  # stuck

    @service(Trigger, "~/status")
    async def status(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


class Tower(Node):
    default_group = Group(1)
    status = Client(Trigger, "/rocket/status")

    @service(Trigger, "~/clear")
    async def clear(self, request: Trigger.Request) -> Trigger.Response:
        return await self.status.call(Trigger.Request())
