"""A call from a thread that holds the group which the answer needs."""

from __future__ import annotations

from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Arm(Node):
    serial_port = Group(1, thread=True)
    check = Client(Trigger, "/safety/check")

    @timer(0.2, group=serial_port)
    def move(self) -> None:
        answer = self.check.call_sync(Trigger.Request())  # stuck
        self.log.info("moved to %s", answer.message)

    @service(Trigger, "~/position", group=serial_port)
    def position(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True, message="0.5")


class Safety(Node):
    position = Client(Trigger, "/arm/position")

    @service(Trigger, "~/check")
    async def check(self, request: Trigger.Request) -> Trigger.Response:
        return await self.position.call(Trigger.Request())
