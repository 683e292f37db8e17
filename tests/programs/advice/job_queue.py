"""A queue that a handler of the same group fills."""

from __future__ import annotations

import asyncio
from typing import Any

from graphflow import Client, Group, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Worker(Node):
    default_group = Group(1)

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.jobs: asyncio.Queue[str] = asyncio.Queue()

    @timer(0.1)
    async def work(self) -> None:
        job = await self.jobs.get()  # stuck
        self.log.info("did %s", job)

    @service(Trigger, "~/add_job")
    async def add_job(self, request: Trigger.Request) -> Trigger.Response:
        await self.jobs.put("a job")
        return Trigger.Response(success=True)


class Boss(Node):
    add_job = Client(Trigger, "/worker/add_job")

    @timer(0.3)
    async def order(self) -> None:
        await self.add_job.call(Trigger.Request())
