"""A flag that is polled, and that a handler of the same group sets."""

from __future__ import annotations

from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import SetBool


class Robot(Node):
    default_group = Group(1)
    door_is_open = False

    @timer(0.2)
    async def go_through(self) -> None:
        self.door_is_open = False
        while not self.door_is_open:
            await self.clock.sleep(0.05)  # stuck
        self.log.info("through")

    @service(SetBool, "~/door")
    async def on_door(self, request: SetBool.Request) -> SetBool.Response:
        self.door_is_open = request.data
        return SetBool.Response(success=True)


class Janitor(Node):
    robot = Client(SetBool, "/robot/door")

    @timer(0.3)
    async def open_up(self) -> None:
        await self.robot.call(SetBool.Request(data=True))
