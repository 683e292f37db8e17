"""Waits in objects that a node holds, by way of children, threads and lambdas: programs that cannot go on, and such as
look like them and may.
"""

from __future__ import annotations

import asyncio
import threading
import time
from dataclasses import dataclass, field
from typing import Any, ClassVar

import pytest

from graphflow import Node, subscription
from graphflow.msgs.geometry_msgs.msg import Pose, PoseStamped
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from tests.cases import slow
from tests.deadlock.cast import Caplog, Robot, reports, say
from tests.flat import flat


class Navigator:
    """Drives somewhere, as far as anybody knows."""

    def __init__(self) -> None:
        self.is_there = False

    async def wait(self) -> None:
        while not self.is_there:
            await asyncio.sleep(0.05)

    def mark(self) -> None:
        self.is_there = True

    def look(self) -> bool:
        return self.is_there

    @property
    def has_arrived(self) -> bool:
        return self.is_there


@dataclass
class State:
    ready: asyncio.Event = field(default_factory=asyncio.Event)


class Navigates(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.nav = Navigator()

    async def go(self, _: String) -> None:
        await self.nav.wait()

    async def arrive(self, _: String) -> None:
        self.nav.mark()


class NavigatesByHand(Navigates):
    async def arrive(self, _: String) -> None:
        self.nav.is_there = True


class PollsAMethod(Navigates):
    """The most usual way to wait for a navigator."""

    async def go(self, _: String) -> None:
        while not self.nav.look():
            await self.clock.sleep(0.05)


class PollsAProperty(Navigates):
    async def go(self, _: String) -> None:
        while self.is_running and not self.nav.has_arrived:
            await self.clock.sleep(0.05)


class PollsAnAttribute(NavigatesByHand):
    has_given_up = False

    async def go(self, _: String) -> None:
        while not (self.nav.is_there or self.has_given_up):
            await self.clock.sleep(0.05)


class KeepsState(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.state = State()

    async def go(self, _: String) -> None:
        await self.state.ready.wait()

    async def arrive(self, _: String) -> None:
        self.state.ready.set()


class PollsAnEvent(KeepsState):
    async def go(self, _: String) -> None:
        while not self.state.ready.is_set():
            await self.clock.sleep(0.05)


class Comes(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.barrier = asyncio.Barrier(2)

    async def go(self, _: String) -> None:
        await self.barrier.wait()

    async def arrive(self, _: String) -> None:
        await self.barrier.wait()


class RunsWhile(Robot):
    """The most usual loop there is."""

    pose: Any = None

    async def go(self, _: String) -> None:
        while self.is_running and self.pose is None:
            await self.clock.sleep(0.05)

    async def arrive(self, message: String) -> None:
        self.pose = message

    def unrelated(self, given: PoseStamped) -> PoseStamped:
        """Fills messages, whose fields are called as the node's attribute is."""
        made = PoseStamped()
        made.pose = Pose()
        given.pose = made.pose
        return made


class ByALambda(RunsWhile):
    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(String, "/arrive", lambda message: self.keep(message), 10, group=self.motion)

    async def arrive(self, message: String) -> None:
        """Nothing."""

    def keep(self, message: String) -> None:
        self.pose = message


class SendsToTheLoop(KeepsState):
    def __init__(self) -> None:
        super().__init__()
        self.there = asyncio.Event()
        self.create_subscription(String, "/drive", self.drive, 10, group=self.motion, thread=True)

    async def go(self, _: String) -> None:
        """Nothing."""

    def drive(self, _: String) -> None:
        asyncio.run_coroutine_threadsafe(self.there.wait(), self.context.loop).result()

    async def arrive(self, _: String) -> None:
        self.there.set()


class Rate:
    """Made by hand."""

    def __init__(self, period: float) -> None:
        self.period, self.next = period, time.monotonic() + period

    async def sleep(self) -> None:
        await asyncio.sleep(max(0.0, self.next - time.monotonic()))
        while self.next < time.monotonic():
            self.next += self.period


class KeepsARate(RunsWhile):
    def __init__(self) -> None:
        super().__init__()
        self.rate = Rate(0.05)

    async def go(self, _: String) -> None:
        while self.pose is None:
            await self.rate.sleep()


class MakesARate(RunsWhile):
    async def go(self, _: String) -> None:
        rate = Rate(0.05)
        while self.pose is None:
            await rate.sleep()


class Gathers(KeepsState):
    async def poll(self) -> None:
        while not self.state.ready.is_set():
            await self.clock.sleep(0.05)

    async def go(self, _: String) -> None:
        async with asyncio.TaskGroup() as group:
            group.create_task(self.wait_there())
            group.create_task(self.clock.sleep(0.1))

    async def wait_there(self) -> None:
        await asyncio.gather(self.state.ready.wait(), self.clock.sleep(0.1))


@slow
@pytest.mark.parametrize(
    ("program", "what", "how"),
    [
        (Navigates, "self.nav.is_there", "arrive, which sets it,"),
        (NavigatesByHand, "self.nav.is_there", "arrive, which sets it,"),
        (PollsAMethod, "self.nav.is_there", "arrive, which sets it,"),
        (PollsAProperty, "self.nav.is_there", "arrive, which sets it,"),
        (PollsAnAttribute, "self.has_given_up and self.nav.is_there", "arrive, which sets it,"),
        (PollsAnEvent, "self.state.ready", "arrive, which sets it,"),
        (KeepsState, "self.state.ready", "arrive, which sets it,"),
        (Comes, "self.barrier", "arrive, which comes to it,"),
        (RunsWhile, "self.pose", "arrive, which sets it,"),
        (ByALambda, "self.pose", "sets it"),
        (KeepsARate, "self.pose", "arrive, which sets it,"),
        (MakesARate, "self.pose", "arrive, which sets it,"),
        (SendsToTheLoop, "self.there", "arrive, which sets it,"),
        (Gathers, "self.state.ready", "arrive, which sets it,"),
    ],
)
async def test_a_program_that_cannot_go_on(
    graph: Graph, caplog: Caplog, program: type[Node], what: str, how: str
) -> None:
    """It is told what for, and who is kept out."""
    graph.deadlock, graph.waits_outside = "report", False
    await graph.start(program())
    await say(graph, "/go", "/drive", "/arrive") if program is SendsToTheLoop else await say(graph, "/go", "/arrive")
    for turn in range(500):  # a thread needs time of its own, on a busy machine more than a little
        await asyncio.sleep(0.02)
        await graph.clock.advance(0.5)
        if turn >= 3 and reports(caplog):
            break
    [text] = reports(caplog)
    told = flat(text)
    assert told.startswith("LIKELY DEADLOCK: subscription ")
    assert f" waits for {what}, and " in told
    assert how in told


# Programs that look like them


class GivesItAway(Navigates):
    """Somebody else may mark it."""

    known: ClassVar[list[Navigator]] = []

    def __init__(self) -> None:
        super().__init__()
        self.known.append(self.nav)


class TakesWhatIsThere(Navigates):
    """It was made elsewhere, where it is known."""

    everybodys = Navigator()

    def __init__(self) -> None:
        super().__init__()
        self.nav = self.everybodys


class Restless(Navigator):
    """Is there by itself after a while."""

    def __init__(self) -> None:
        super().__init__()
        threading.Timer(600.0, self.mark).cancel()


class IsThereByItself(Navigates):
    def __init__(self) -> None:
        super().__init__()
        self.nav = Restless()


class IsReplaced(Navigates):
    """The one that is waited for may be another one's by now."""

    async def arrive(self, _: String) -> None:
        self.nav = Navigator()


class OnlyLooks(Navigates):
    """Nobody marks it that is seen: it is not understood."""

    async def arrive(self, _: String) -> None:
        self.nav.look()


class HandsAMethodOn(Navigates):
    """It is called whenever that is."""

    async def on_start(self) -> None:
        threading.Timer(600.0, self.nav.mark).cancel()


class PollsWhatIsHandedOn(PollsAMethod, HandsAMethodOn):
    """The same."""


class PollsWhatIsMarkedOutside(PollsAMethod):
    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(String, "/free", self.free, 10)

    def free(self, _: String) -> None:
        self.nav.mark()


class PollsWhatIsGivenAway(PollsAMethod, GivesItAway):
    """Somebody else may mark it."""


class PollsWhatIsThereByItself(PollsAMethod, IsThereByItself):
    """A timer of its own marks it."""


class Stepping(Navigator):
    """Goes on by being asked to, and is there after some steps."""

    def step(self) -> None:
        self.mark()

    def fail(self) -> None:
        raise TimeoutError


class PollsAndSteps(PollsAMethod):
    """What it polls it changes itself."""

    def __init__(self) -> None:
        super().__init__()
        self.nav: Stepping = Stepping()

    async def go(self, _: String) -> None:
        while not self.nav.look():
            await self.clock.sleep(600.0)
            self.nav.step()


class PollsAndSets(PollsAMethod):
    async def go(self, _: String) -> None:
        while not self.nav.look():
            await self.clock.sleep(600.0)
            self.nav.is_there = True


class PollsAndFails(PollsAndSteps):
    """An error ends the loop."""

    async def go(self, _: String) -> None:
        while not self.nav.look():
            await self.clock.sleep(600.0)
            self.nav.fail()


class Driver(threading.Thread):
    """Runs by itself."""

    is_there = False

    def run(self) -> None:
        self.is_there = True

    def mark(self) -> None:
        self.is_there = True

    def look(self) -> bool:
        return self.is_there


class PollsAThread(Robot):
    """What it inherits calls its methods."""

    def __init__(self) -> None:
        super().__init__()
        self.nav = Driver()

    async def go(self, _: String) -> None:
        while not self.nav.look():
            await self.clock.sleep(0.05)

    async def arrive(self, _: String) -> None:
        self.nav.mark()


class Other(Node):
    """A node, whose handlers are called for it."""

    is_there = False

    @subscription(String, "/free")
    async def mark(self, _: String) -> None:
        self.is_there = True

    async def wait(self) -> None:
        while not self.is_there:
            await asyncio.sleep(0.05)


class PollsANode(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.nav = Other()

    async def go(self, _: String) -> None:
        while not self.nav.is_there:
            await self.clock.sleep(0.05)

    async def arrive(self, message: String) -> None:
        await self.nav.mark(message)


class WaitsInANode(PollsANode):
    async def go(self, _: String) -> None:
        await self.nav.wait()


class FillsWhatMayBeTheNode(Robot):
    """What is filled is no message."""

    scan: Any = None

    async def go(self, _: String) -> None:
        while self.is_running and self.scan is None:
            await self.clock.sleep(0.05)

    async def arrive(self, message: String) -> None:
        self.scan = message

    def unrelated(self, given: Any) -> Any:
        given.scan = None
        return given


class ObligingRate(Rate):
    """It does more than let time pass."""

    def __init__(self, work: Any) -> None:
        super().__init__(0.05)
        self.work = work

    async def sleep(self) -> None:
        await self.work()


class WorksMeanwhile(MakesARate):
    async def go(self, _: String) -> None:
        rate = ObligingRate(self.work)
        while self.pose is None:
            await rate.sleep()

    async def work(self) -> None:
        await self.clock.sleep(0.05)


class MarkedOutside(Navigates):
    """A handler of no group marks it."""

    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(String, "/free", self.free, 10)

    def free(self, _: String) -> None:
        self.nav.mark()


@pytest.mark.parametrize(
    "program",
    [
        GivesItAway,
        TakesWhatIsThere,
        IsThereByItself,
        IsReplaced,
        OnlyLooks,
        HandsAMethodOn,
        PollsWhatIsHandedOn,
        PollsWhatIsMarkedOutside,
        PollsWhatIsGivenAway,
        PollsWhatIsThereByItself,
        PollsAndSteps,
        PollsAndSets,
        PollsAndFails,
        PollsAThread,
        PollsANode,
        WaitsInANode,
        WorksMeanwhile,
        FillsWhatMayBeTheNode,
        MarkedOutside,
    ],
)
async def test_a_program_that_may_go_on(graph: Graph, caplog: Caplog, program: type[Node]) -> None:
    """Nothing is told."""
    graph.deadlock = "report"
    await graph.start(program())
    await say(graph, "/go", "/arrive")
    for _ in range(4):
        await asyncio.sleep(0.02)  # some wait in threads, for which the graph's clock is none
        await graph.clock.advance(0.5)
    assert reports(caplog) == []
