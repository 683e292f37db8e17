"""A ring of an event, which needs a group, and of two calls, one of which holds it."""

from __future__ import annotations

import asyncio
from typing import Any

from graphflow import Client, Group, Node, Publisher, service, subscription, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Trigger


class Pilot(Node):
    default_group = Group(1)
    watch = Client(Trigger, "/guard/watch")

    @timer(0.5)
    async def fly(self) -> None:
        await self.watch.call(Trigger.Request())
        self.log.info("is watched")

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


class Guard(Node):
    radio = Group(1)
    pilot = Client(Trigger, "/pilot/answer")

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.noticed = asyncio.Event()

    @service(Trigger, "~/watch")
    async def on_watch(self, request: Trigger.Request) -> Trigger.Response:
        self.noticed.clear()
        await self.noticed.wait()  # stuck
        return Trigger.Response(success=True)

    @timer(0.1, group=radio)
    async def talk(self) -> None:
        await self.clock.sleep(0.7)
        await self.pilot.call(Trigger.Request())

    @subscription(String, "news", group=radio)
    async def on_news(self, message: String) -> None:
        self.noticed.set()


class Reporter(Node):
    news = Publisher(String, "news")

    @timer(0.1)
    async def tell(self) -> None:
        self.news.publish(String(data="all quiet"))
