"""A future that a handler of the same group resolves."""

from __future__ import annotations

import asyncio

from graphflow import Group, Node, Publisher, subscription, timer
from graphflow.msgs.std_msgs.msg import Float64


class Navigator(Node):
    default_group = Group(1)
    next_fix: asyncio.Future[float] | None = None

    @timer(0.2)
    async def locate(self) -> None:
        self.next_fix = asyncio.get_running_loop().create_future()
        fix = await self.next_fix  # stuck
        self.log.info("at %.1f", fix)

    @subscription(Float64, "fixes")
    async def on_fix(self, message: Float64) -> None:
        if self.next_fix is not None and not self.next_fix.done():
            self.next_fix.set_result(message.data)


class Gps(Node):
    fixes = Publisher(Float64, "fixes")

    @timer(0.1)
    async def fix(self) -> None:
        self.fixes.publish(Float64(data=4.5))
