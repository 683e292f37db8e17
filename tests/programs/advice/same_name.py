"""Two nodes that ask each other, by services of one name."""

from __future__ import annotations

from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Arm(Node):
    default_group = Group(1)
    camera = Client(Trigger, "/camera/status")

    @timer(0.2)
    async def look_around(self) -> None:
        await self.camera.call(Trigger.Request())  # stuck
        self.log.info("all well")

    @service(Trigger, "~/status")
    async def status(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


class Camera(Node):
    arm = Client(Trigger, "/arm/status")

    @service(Trigger, "~/status")
    async def status(self, request: Trigger.Request) -> Trigger.Response:
        return await self.arm.call(Trigger.Request())
