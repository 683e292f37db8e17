"""Nodes of which two handlers exclude each other, and what several tests ask about deadlocks.

A program's flag has a name that no other code of its file uses on anything but `self`: whatever is written to from
outside its class counts as open to the world, and nothing is ever said of it.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Sequence
from pathlib import Path

import pytest

from graphflow import (
    ActionClient,
    Client,
    Group,
    Node,
    action,
    service,
    subscription,
)
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph

Caplog = pytest.LogCaptureFixture


def at(marker: str) -> str:
    """How a report tells the line of these files that ends with the marker."""
    found = [
        f"({file.name}:{number} in "
        for file in Path(__file__).parent.glob("*.py")
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1)
        if line.endswith(f"# {marker}")
    ]
    [place] = found
    return place


def reports(caplog: Caplog) -> list[str]:
    """The deadlocks that were reported so far; nothing may have failed in the background."""
    assert not [r for r in caplog.records if r.name == "asyncio"]
    texts = [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "ERROR"]
    assert all(text.startswith(("DEADLOCK", "LIKELY DEADLOCK")) for text in texts)
    return texts


def in_vain(caplog: Caplog) -> list[str]:
    """What waits for nothing but its own deadline."""
    return [m for m in (r.getMessage() for r in caplog.records) if m.startswith("WAITS IN VAIN: ")]


def the_report(caplog: Caplog) -> str:
    """The only one."""
    texts = reports(caplog)
    assert len(texts) == 1
    return texts[0]


def cleared(caplog: Caplog) -> list[str]:
    """The deadlocks that were said to be over."""
    return [m for m in (r.getMessage() for r in caplog.records) if m.endswith("has cleared")]


async def say(graph: Graph, *topics: str) -> None:
    for topic in topics:
        graph.publisher(String, topic).publish(String())
        await graph.settle()


class Robot(Node):
    """Two handlers that exclude each other: what the programs below put into them never ends together."""

    node_name = "robot"
    motion = Group(1)

    @subscription(String, "go", group=motion)
    async def go(self, _: String) -> None:
        """Wait for something."""

    @subscription(String, "arrive", group=motion)
    async def arrive(self, _: String) -> None:
        """Bring it about."""

    def others(self) -> Sequence[Node]:
        """Further nodes that the program has."""
        return ()


class Waiter(Robot):
    """Waits for an event that another handler of the group sets."""

    def __init__(self) -> None:
        super().__init__()
        self.arrived = asyncio.Event()

    async def go(self, _: String) -> None:
        await self.arrived.wait()  # stuck: Waiter

    async def arrive(self, _: String) -> None:
        self.arrived.set()


class EventWithin(Waiter):
    async def go(self, _: String) -> None:
        async with self.clock.timeout(5.0):
            await self.arrived.wait()  # stuck: EventWithin


class Driver(Robot):
    """Polls a flag that another handler of the group sets."""

    there = False

    async def go(self, _: String) -> None:
        while not self.there:
            await self.clock.sleep(0.05)  # stuck: Driver

    async def arrive(self, _: String) -> None:
        self.there = True


class Dialler(Robot):
    """Has a service in the group of its handlers, and one outside that takes a second."""

    ping = Client(Empty, "ping")
    pong = Client(Empty, "pong")

    @service(Empty, "ping", group=Robot.motion)
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @service(Empty, "pong")
    async def on_pong(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(1.0)
        return Empty.Response()


class PollsACall(Dialler):
    async def go(self, _: String) -> None:
        asking = asyncio.create_task(self.ping.call(Empty.Request()))
        try:
            while not asking.done():
                await self.clock.sleep(0.05)  # stuck: PollsACall
        finally:
            asking.cancel()


class PollsACallOfItsNodes(Dialler):
    async def go(self, _: String) -> None:
        self.asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        while True:
            if self.asking.done():
                break
            await self.clock.sleep(0.05)  # stuck: PollsACallOfItsNodes

    async def on_shutdown(self) -> None:
        self.asking.cancel()


class PollsSeveral(Dialler):
    async def go(self, _: String) -> None:
        asking = [asyncio.create_task(self.ping.call(Empty.Request())) for _ in range(3)]
        try:
            while not all(each.done() for each in asking):
                await self.clock.sleep(0.05)  # stuck: PollsSeveral
        finally:
            for each in asking:
                each.cancel()


class Planner(Robot):
    """Has an action in the group of its handlers, or that waits for them."""

    plan = ActionClient(Fibonacci, "plan")

    @action(Fibonacci, "plan", group=Robot.motion)
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()


class Promised(Robot):
    """Awaits a future that another handler of the group fulfils."""

    promise: asyncio.Future[None]

    async def go(self, _: String) -> None:
        self.promise = asyncio.get_running_loop().create_future()
        await self.promise  # stuck: Promised

    async def arrive(self, _: String) -> None:
        self.promise.set_result(None)


class DrivesByPose(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.pose = Pose()

    def distance(self, x: float, y: float) -> float:
        return math.hypot(self.pose.x - x, self.pose.y - y)

    async def go(self, _: String) -> None:
        while self.distance(5.0, 5.0) > 0.1:
            await self.clock.sleep(0.05)  # stuck: DrivesByPose

    async def arrive(self, _: String) -> None:
        self.pose = Pose(x=5.0, y=5.0)


class Sleeper(Node):
    """Serves for four seconds, one after the other."""

    work = Group(1)

    @service(Empty, "slow", group=work)
    async def slow(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(4.0)
        return Empty.Response()
