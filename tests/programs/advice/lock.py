"""A lock that is held across a call to another node, which needs it."""

from __future__ import annotations

import asyncio
from typing import Any

from graphflow import Client, Node, service, timer
from graphflow.msgs.std_srvs.srv import Trigger


class Bank(Node):
    audit = Client(Trigger, "/auditor/audit")

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.vault = asyncio.Lock()

    @timer(0.2)
    async def close_day(self) -> None:
        async with self.vault:
            await self.audit.call(Trigger.Request())  # stuck

    @service(Trigger, "~/balance")
    async def balance(self, request: Trigger.Request) -> Trigger.Response:
        async with self.vault:
            return Trigger.Response(success=True)


class Auditor(Node):
    balance = Client(Trigger, "/bank/balance")

    @service(Trigger, "~/audit")
    async def on_audit(self, request: Trigger.Request) -> Trigger.Response:
        return await self.balance.call(Trigger.Request())
