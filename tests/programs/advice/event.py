"""An event that a handler of the same group sets."""

from __future__ import annotations

import asyncio
from typing import Any

from graphflow import Group, Node, Publisher, subscription, timer
from graphflow.msgs.std_msgs.msg import String


class Explorer(Node):
    default_group = Group(1)

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.seen = asyncio.Event()

    @timer(0.2)
    async def explore(self) -> None:
        self.seen.clear()
        await self.seen.wait()  # stuck
        self.log.info("found it")

    @subscription(String, "sightings")
    async def on_sighting(self, message: String) -> None:
        self.seen.set()


class Camera(Node):
    sightings = Publisher(String, "sightings")

    @timer(0.1)
    async def look(self) -> None:
        self.sightings.publish(String(data="ball"))
