"""Programs that poll what cannot change, as students write them: each is explained, with the right line."""

from __future__ import annotations

import asyncio
import math
from enum import Enum

import numpy as np
import pytest

from graphflow import Client, Group, Node, subscription, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from tests.cases import sample
from tests.deadlock.cast import Caplog, Driver, DrivesByPose, Robot, Sleeper, at, reports, say, the_report
from tests.deadlock.deadlocked import Stuck, cannot_go_on, stuck


class WholeProgram(Node):
    """All in one class, as it is first written."""

    node_name = "robot"
    default_group = Group(1)

    def __init__(self) -> None:
        super().__init__()
        self.at_goal = False

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        self.at_goal = False
        while not self.at_goal:
            await self.clock.sleep(0.05)  # stuck: WholeProgram

    @timer(0.1)
    async def look(self) -> None:
        self.at_goal = True


class ProgramOfRclpys(Node):
    """Everything made by hand, as in rclpy."""

    motion = Group(1)

    def __init__(self) -> None:
        super().__init__("robot")
        self.landed = False
        group = type(self).motion
        self.create_subscription(String, "go", self.on_go, 10, group=group)
        self.create_subscription(String, "arrive", self.on_arrive, 10, group=group)

    async def on_go(self, _: String) -> None:
        while not self.landed:
            await self.clock.sleep(0.05)  # stuck: ProgramOfRclpys

    async def on_arrive(self, _: String) -> None:
        self.landed = True


class TurnsUntilItIsReady(Robot):
    is_ready_now = False

    async def go(self, _: String) -> None:
        while True:
            await self.clock.sleep(0.05)  # stuck: TurnsUntilItIsReady
            if not self.is_ready_now:
                continue
            break

    async def arrive(self, _: String) -> None:
        self.is_ready_now = True


class SleepsInAsyncio(Driver):
    async def go(self, _: String) -> None:
        while not self.there:
            await asyncio.sleep(0.05)  # stuck: SleepsInAsyncio


class CountsTurns(Driver):
    async def go(self, _: String) -> None:
        async for _turn in self.clock.every(0.1):  # stuck: CountsTurns
            if self.there:
                break


class LeavesInTheMiddle(Driver):
    async def go(self, _: String) -> None:
        while True:
            if self.there:
                return
            await self.clock.sleep(0.05)  # stuck: LeavesInTheMiddle


class PausesInAHelper(Driver):
    async def pause(self) -> None:
        await self.clock.sleep(0.05)  # stuck: PausesInAHelper

    async def go(self, _: String) -> None:
        while not self.there:
            await self.pause()


class WaitsInAHelper(Driver):
    async def wait_there(self) -> None:
        while not self.there:
            await self.clock.sleep(0.05)  # stuck: WaitsInAHelper

    async def go(self, _: String) -> None:
        await self.wait_there()


class WaitsInAFunction(Driver):
    async def go(self, _: String) -> None:
        async def wait_there() -> None:
            while not self.there:
                await self.clock.sleep(0.05)  # stuck: WaitsInAFunction

        await wait_there()


class SetByAHelper(Driver):
    def note_it(self) -> None:
        self.there = True

    async def arrive(self, _: String) -> None:
        self.note_it()


class SetByTheParentsHandler(Driver):
    """The handler is the child's, and what it does the parent's."""

    async def arrive(self, message: String) -> None:
        await super().arrive(message)


class SetInADictionary(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.state = {"phase": "driving"}

    async def go(self, _: String) -> None:
        while self.state["phase"] != "there":
            await self.clock.sleep(0.05)  # stuck: SetInADictionary

    async def arrive(self, _: String) -> None:
        self.state["phase"] = "there"


class SetBehindAProperty(Driver):
    @property
    def is_there(self) -> bool:
        return self.there

    async def go(self, _: String) -> None:
        while not self.is_there:
            await self.clock.sleep(0.05)  # stuck: SetBehindAProperty


class Docks(Robot):
    docked = False

    async def go(self, _: String) -> None:
        while not self.docked:
            await self.clock.sleep(0.05)  # stuck: Docks

    async def arrive(self, _: String) -> None:
        self.docked = True


def in_words(robot: Docks) -> str:
    """Read what is only read from outside."""
    return "docked" if robot.docked else "at sea"


class NamesTheDistance(DrivesByPose):
    async def go(self, _: String) -> None:
        while (left := self.distance(5.0, 5.0)) > 0.1:
            self.log.debug("%g m to go", left)
            await self.clock.sleep(0.05)  # stuck: NamesTheDistance


class TakesThePoseApart(DrivesByPose):
    async def go(self, _: String) -> None:
        while True:
            x, y = self.pose.x, self.pose.y
            if math.hypot(x - 5.0, y - 5.0) < 0.1:
                break
            await self.clock.sleep(0.05)  # stuck: TakesThePoseApart


class CountsInAList(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.seen: list[str] = []

    async def go(self, _: String) -> None:
        while len(self.seen) < 2:
            await self.clock.sleep(0.05)  # stuck: CountsInAList

    async def arrive(self, message: String) -> None:
        self.seen.append(message.data)


class AsksWhoIsReady(Robot):
    """All of several must have said that they are."""

    def __init__(self) -> None:
        super().__init__()
        self.ready = {"left": False, "right": False}

    async def go(self, _: String) -> None:
        while not all(self.ready.values()):
            await self.clock.sleep(0.05)  # stuck: AsksWhoIsReady

    async def arrive(self, message: String) -> None:
        self.ready[message.data] = True


class WaitsForAState(Robot):
    """A state machine of an enumeration, a helper of several lines, and a limit for logging."""

    class Mode(Enum):
        DRIVING = 1
        LANDED = 2

    def __init__(self) -> None:
        super().__init__()
        self.mode = self.Mode.DRIVING

    def is_done(self, wanted: Mode) -> bool:
        if self.mode is None:
            return False
        now = self.mode
        return now == wanted

    async def go(self, _: String) -> None:
        wanted = self.Mode.LANDED
        turns = 0
        while not self.is_done(wanted):
            turns += 1
            if turns % 10 == 0:
                self.log.info("not yet")
            await self.clock.sleep(0.05)  # stuck: WaitsForAState

    async def arrive(self, _: String) -> None:
        self.mode = self.Mode.LANDED


class FollowsAPath(Robot):
    """Positions in arrays."""

    def __init__(self) -> None:
        super().__init__()
        self.spot = np.zeros(2)
        self.target = np.array([5.0, 5.0])

    async def go(self, _: String) -> None:
        for _stop in range(3):
            while np.linalg.norm(self.spot - self.target) > 0.1:
                await self.clock.sleep(0.05)  # stuck: FollowsAPath

    async def arrive(self, _: String) -> None:
        self.spot = np.array([5.0, 5.0])


@pytest.mark.parametrize(
    "case",
    sample(
        [
            stuck(TurnsUntilItIsReady, "self.is_ready_now"),
            stuck(Driver),
            stuck(WholeProgram, "self.at_goal", "timer look", group="default_group"),
            stuck(ProgramOfRclpys, "self.landed", "subscription on_arrive", "subscription on_go"),
            stuck(SleepsInAsyncio),
            stuck(CountsTurns),
            stuck(LeavesInTheMiddle),
            stuck(PausesInAHelper),
            stuck(WaitsInAHelper),
            stuck(WaitsInAFunction),
            stuck(SetByAHelper, marker="Driver"),
            stuck(SetByTheParentsHandler, marker="Driver"),
            stuck(SetInADictionary, "self.state"),
            stuck(SetBehindAProperty),
            stuck(Docks, "self.docked"),
            stuck(CountsInAList, "self.seen"),
            stuck(AsksWhoIsReady, "self.ready"),
            stuck(WaitsForAState, "self.mode"),
            stuck(FollowsAPath, "self.spot and self.target"),
            stuck(DrivesByPose, "self.pose"),
            stuck(NamesTheDistance, "self.pose"),
            stuck(TakesThePoseApart, "self.pose"),
        ]
    ),
)
async def test_a_program_that_cannot_go_on(graph: Graph, caplog: Caplog, case: Stuck) -> None:
    """It is told once, within a second: who holds what and waits where, for whom that cannot run."""
    await cannot_go_on(graph, caplog, case)


class DistractedDriver(Driver):
    """Waits for another process, in no group, while it drives."""

    slow = Client(Empty, "slow")

    @subscription(String, "ask")
    async def ask(self, _: String) -> None:
        await self.slow.call(Empty.Request())


async def test_what_only_the_source_tells_must_have_lasted(graph: Graph, caplog: Caplog) -> None:
    """Nothing is said of a handler that has just begun to wait, whoever makes somebody look just then."""
    graph.deadlock = "report"
    await graph.start(DistractedDriver(), Sleeper())
    await say(graph, "/ask")
    await graph.clock.advance(0.2)
    await say(graph, "/go", "/arrive")
    await graph.clock.advance(0.1)
    assert reports(caplog) == []
    await graph.clock.advance(1.0)

    assert at("stuck: Driver") in the_report(caplog)
