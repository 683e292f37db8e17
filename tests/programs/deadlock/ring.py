"""Nodes that wait for each other: rings, chains that come back, held loops; a test opens the gate of each."""

from __future__ import annotations

import asyncio
import ctypes
import os
from pathlib import Path
from typing import Any

from graphflow import ActionClient, CallError, Client, GoalCanceled, Group, Node, Param, action, service, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_srvs.srv import Trigger

HERE = Path(__file__).parent


class Gated(Node):
    async def pass_gate(self) -> None:
        while not (HERE / f"open{self.full_name.replace('/', '.')}").exists():
            await self.clock.sleep(0.01)


class Member(Gated):
    """Asks the next one, from the group in which it answers."""

    work = Group(1)
    following = Client(Trigger, "following")
    limit = Param(0.0)
    has_asked = False

    @timer(0.1, group=work)
    async def ask(self) -> None:
        if self.has_asked:
            return
        self.has_asked = True
        self.log.info("is at it (%s)", self.context.session.zid)
        await self.pass_gate()
        self.log.info("asks")
        try:
            await self.toil()
            self.log.info("was answered")
        except CallError as error:
            self.log.warning("%s: %s", type(error).__name__, error)

    async def toil(self) -> None:
        await self.following.call(Trigger.Request(), timeout=self.limit or None)  # stuck: Member

    @service(Trigger, "~/answer", group=work)
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


class Canceller(Member):
    """Can be told to wait no more."""

    async def toil(self) -> None:
        self.asking = asyncio.ensure_future(self.following.call(Trigger.Request(), timeout=None))
        await asyncio.wait([self.asking])  # stuck: Canceller

    @service(Trigger, "~/give_up")
    async def give_up(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=self.asking.cancel())


class Boss(Member):
    """Asks two at once, or is one of those whom the boss asks, and then asks it back."""

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        others = [other for other in "abc" if f"/{other}" != self.full_name]
        self.orders = [self.create_client(Trigger, f"/{other}/obey") for other in others]
        self.answers = {other: self.create_client(Trigger, f"/{other}/answer") for other in others}

    async def toil(self) -> None:
        await asyncio.gather(*(order.call(Trigger.Request(), timeout=None) for order in self.orders))

    @service(Trigger, "~/obey")
    async def obey(self, request: Trigger.Request) -> Trigger.Response:
        [boss] = HERE.glob("open.*")
        return await self.answers[boss.suffix[1:]].call(Trigger.Request(), timeout=None)


class Echo(Node):
    """Asks back whoever asks it."""

    back = Client(Trigger, "back")

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return await self.back.call(Trigger.Request(), timeout=None)  # stuck: Echo


class Blocker(Node):
    """Waits for an answer on the event loop."""

    following = Client(Trigger, "following")

    @timer(0.3)
    def ask(self) -> None:
        self.following.call_sync(Trigger.Request(), timeout=None)  # stuck: Blocker
        self.log.info("was answered")

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


class Slow(Gated):
    """Serves one after the other."""

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        self.log.info("serves")
        await self.pass_gate()
        return Trigger.Response(success=True)


class Sleepy(Node):
    """Holds its event loop while it serves, until the test writes to a pipe."""

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        self.log.info("serves")
        self.hold()
        return Trigger.Response(success=True)

    def hold(self) -> None:
        os.open(HERE / "pipe", os.O_RDONLY)  # held: Sleepy


class Greedy(Sleepy):
    """Holds the interpreter, too, so that no thread of the process runs."""

    def hold(self) -> None:
        ctypes.PyDLL(None).open(bytes(HERE / "pipe"), os.O_RDONLY)  # held: Greedy


class Customer(Member):
    """Waits for a goal in the group in which it tells where it is."""

    order = ActionClient(Fibonacci, "order")

    async def toil(self) -> None:
        self.sent = await self.order.send_goal(Fibonacci.Goal(order=1))
        try:
            await self.sent.result()  # stuck: Customer
        except GoalCanceled:
            self.log.info("cancelled")

    @service(Trigger, "~/give_up")
    async def give_up(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=await self.sent.cancel())


class Courier(Node):
    """Asks its customer for the way."""

    position = Client(Trigger, "position")

    @action(Fibonacci, "order")
    async def deliver(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.position.call(Trigger.Request(), timeout=None)  # stuck: Courier
        return Fibonacci.Result()
