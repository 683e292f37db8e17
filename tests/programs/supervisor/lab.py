"""Nodes that misbehave, each in one way, and one that does not."""

from __future__ import annotations

import asyncio
import os
import time
from typing import Any

from graphflow import Node, service, task
from graphflow.msgs.std_srvs.srv import Trigger


class Good(Node):
    @service(Trigger, "~/ask")
    async def ask(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True, message=os.environ.get("COLOUR", ""))


class Stubborn(Node):
    @task
    async def ignore(self) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            self.log.warning("no")
            time.sleep(60.0)


class Crashes(Node):
    @task
    async def fall(self) -> None:
        raise RuntimeError("the bridge is out")


class Refuses(Node):
    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        raise ValueError("no camera")


class Ends(Node):
    @task
    async def end(self) -> None:
        self.log.info("done")
        self.shutdown()


class Leaves(Node):
    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        os._exit(0)


class Parent(Node):
    @task
    async def beget(self) -> None:
        pid = os.spawnlp(os.P_NOWAIT, "sleep", "sleep", "600")
        self.log.info("child %d.", pid)


class Fails(Node):
    @service(Trigger, "fails")
    async def fail(self, request: Trigger.Request) -> Trigger.Response:
        raise OSError("the disk is full")
