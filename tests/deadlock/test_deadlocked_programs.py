"""Programs that cannot go on, as students write them: each is explained, with the right line."""

from __future__ import annotations

import asyncio
import math
import threading
from contextlib import suppress
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
import pytest

from graphflow import (
    ActionClient,
    Client,
    Group,
    Node,
    Param,
    action,
    service,
    subscription,
    task,
    timer,
)
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from tests.cases import sample
from tests.deadlock.cast import (
    Caplog,
    Dialler,
    Driver,
    DrivesByPose,
    Planner,
    PollsACall,
    PollsACallOfItsNodes,
    PollsSeveral,
    Promised,
    Robot,
    Sleeper,
    Waiter,
    at,
    cleared,
    in_vain,
    reports,
    say,
    the_report,
)
from tests.flat import flat


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


class EventWithin(Waiter):
    async def go(self, _: String) -> None:
        async with self.clock.timeout(5.0):
            await self.arrived.wait()  # stuck: EventWithin


class EventWaitedFor(Waiter):
    async def go(self, _: String) -> None:
        await asyncio.wait_for(self.arrived.wait(), 60.0)  # stuck: EventWaitedFor


class EventTriedFor(Waiter):
    async def go(self, _: String) -> None:
        for _attempt in range(3):
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self.arrived.wait(), 30.0)  # stuck: EventTriedFor


class EventGathered(Waiter):
    async def go(self, _: String) -> None:
        await asyncio.gather(self.arrived.wait(), self.clock.sleep(60.0))  # stuck: EventGathered


class EventPolled(Waiter):
    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            await self.clock.sleep(0.05)  # stuck: EventPolled


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


class EventOfTheNextMessage(Waiter):
    """The handler sets it itself, at its second message, which its first run does not let in."""

    heard = 0

    async def go(self, _: String) -> None:
        """Be quick."""

    async def arrive(self, _: String) -> None:
        self.heard += 1
        if self.heard == 2:
            self.arrived.set()
        await self.arrived.wait()  # stuck: EventOfTheNextMessage


class Eater(Robot):
    """Waits at a queue that another handler of the group fills."""

    def __init__(self) -> None:
        super().__init__()
        self.words = asyncio.Queue[String]()

    async def go(self, _: String) -> None:
        await self.words.get()  # stuck: Eater

    async def arrive(self, message: String) -> None:
        self.words.put_nowait(message)


class QueuePolled(Eater):
    async def go(self, _: String) -> None:
        while self.words.empty():
            await self.clock.sleep(0.05)  # stuck: QueuePolled


class Feeder(Robot):
    """Waits at a full queue that another handler of the group empties."""

    def __init__(self) -> None:
        super().__init__()
        self.plates: asyncio.Queue[String] = asyncio.Queue(1)

    async def go(self, message: String) -> None:
        await self.plates.put(message)
        await self.plates.put(message)  # stuck: Feeder

    async def arrive(self, _: String) -> None:
        self.plates.get_nowait()


class PermitsTwiceInEach(Robot):
    """Each of two parts takes one of two permits, and then wants another."""

    def __init__(self) -> None:
        super().__init__()
        self.permits = asyncio.Semaphore(2)

    async def part(self) -> None:
        async with self.permits:
            await self.clock.sleep(0.1)
            async with self.permits:  # stuck: PermitsTwiceInEach
                pass

    async def go(self, _: String) -> None:
        await asyncio.gather(self.part(), self.part())


class PermitsInTime(PermitsTwiceInEach):
    async def go(self, _: String) -> None:
        async with self.clock.timeout(5.0), asyncio.TaskGroup() as group:
            group.create_task(self.part())
            group.create_task(self.part())


class PermitsInTurn(PermitsTwiceInEach):
    """There is one more than are held."""

    def __init__(self) -> None:
        super().__init__()
        self.permits = asyncio.Semaphore(3)


@pytest.mark.parametrize(
    ("program", "words"),
    [
        (PermitsTwiceInEach, "LIKELY DEADLOCK: task part of /robot waits for self.permits, which it holds itself;"),
        (PermitsInTime, "WAITS IN VAIN: task part of /robot waits for self.permits, which it holds itself,"),
        (PermitsInTurn, ""),
    ],
)
async def test_the_parts_of_a_gather(graph: Graph, caplog: Caplog, program: type[Robot], words: str) -> None:
    """Each holds for itself what it has entered."""
    graph.deadlock = "report"
    await graph.start(program())
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    texts = [*reports(caplog), *in_vain(caplog)]
    assert len(texts) == bool(words)
    for told in map(flat, texts):
        assert told.startswith(words)
        assert f"waits for self.permits {at('stuck: PermitsTwiceInEach')}part, for" in told
        assert "behind them: subscription go of /robot" in told


class PermitsAcquiredTwice(PermitsTwiceInEach):
    """The same by hand."""

    async def part(self) -> None:
        await self.permits.acquire()
        await self.clock.sleep(0.1)
        await self.permits.acquire()  # stuck: PermitsAcquiredTwice
        self.permits.release()
        self.permits.release()


class LockAcquiredTwice(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.bar = asyncio.Lock()

    async def part(self) -> None:
        await self.bar.acquire()
        await self.bar.acquire()  # stuck: LockAcquiredTwice
        self.bar.release()
        self.bar.release()

    async def go(self, _: String) -> None:
        await asyncio.gather(*(self.part() for _ in range(2)))


@pytest.mark.parametrize("program", [PermitsAcquiredTwice, LockAcquiredTwice])
async def test_parts_of_a_gather_that_only_release(graph: Graph, caplog: Caplog, program: type[Robot]) -> None:
    """What one of them holds is not to be seen; but all that could release it stand still."""
    graph.deadlock = "report"
    await graph.start(program())
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    told = flat(the_report(caplog))
    assert told.startswith("LIKELY DEADLOCK: subscription go of /robot waits for self.")
    assert f"task part of /robot {at(f'stuck: {program.__name__}')}part, for" in told.replace("  ", " ")


class Keeper:
    """Keeps a goal, as a navigator does."""

    task: Any = None

    def is_over(self) -> bool:
        return self.task is not None and self.task.done


class PollsAKeptGoal(Planner):
    def __init__(self) -> None:
        super().__init__()
        self.keeper = Keeper()

    async def go(self, _: String) -> None:
        self.keeper.task = await self.plan.send_goal(Fibonacci.Goal(order=3))
        while not self.keeper.is_over():
            await self.clock.sleep(0.05)  # stuck: PollsAKeptGoal


async def test_a_goal_that_an_object_of_the_nodes_keeps(graph: Graph, caplog: Caplog) -> None:
    """It is polled by a method that first asks whether there is one."""
    graph.deadlock = "report"
    await graph.start(PollsAKeptGoal())
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    assert f"or the result of action /plan {at('stuck: PollsAKeptGoal')}go" in flat(the_report(caplog))


class PlansInTurn(Node):
    """Its action, which another node has too, waits for its handlers."""

    motion = Group(1)
    plan = ActionClient(Fibonacci, "/plan")

    @subscription(String, "/go", group=motion)
    async def go(self, _: String) -> None:
        handle = await self.plan.send_goal(Fibonacci.Goal(order=3))
        await handle.result()  # stuck: PlansInTurn

    @action(Fibonacci, "/plan", group=motion, policy="queue")
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()


async def test_a_goal_that_two_servers_have(graph: Graph, caplog: Caplog) -> None:
    """Neither can begin it."""
    graph.deadlock = "report"
    await graph.start(PlansInTurn("left"), PlansInTurn("right"))
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    assert f"waits for the result of action /plan {at('stuck: PlansInTurn')}go" in flat(the_report(caplog))


class SemaphoreAcquired(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.permits = asyncio.Semaphore(0)

    async def go(self, _: String) -> None:
        await self.permits.acquire()  # stuck: SemaphoreAcquired

    async def arrive(self, _: String) -> None:
        self.permits.release()


class Notified(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.news = asyncio.Condition()
        self.has_news = False

    async def go(self, _: String) -> None:
        async with self.news:
            await self.news.wait()  # stuck: Notified

    async def arrive(self, _: String) -> None:
        async with self.news:
            self.has_news = True
            self.news.notify_all()


class NotifiedFor(Notified):
    async def go(self, _: String) -> None:
        async with self.news:
            await self.news.wait_for(lambda: self.has_news)  # stuck: NotifiedFor


class PromisedByAnotherName(Promised):
    async def go(self, _: String) -> None:
        promise = self.promise = asyncio.get_running_loop().create_future()
        await promise  # stuck: PromisedByAnotherName


class PromisedInTime(Promised):
    async def go(self, _: String) -> None:
        self.promise = asyncio.get_running_loop().create_future()
        await asyncio.wait_for(self.promise, 60.0)  # stuck: PromisedInTime


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


class CallsThreeDown(Dialler):
    async def go(self, _: String) -> None:
        await self.prepare()

    async def prepare(self) -> None:
        await self.calibrate()

    async def calibrate(self) -> None:
        await self.ask()

    async def ask(self) -> None:
        await self.ping.call(Empty.Request())  # stuck: CallsThreeDown


class CallsInTime(Dialler):
    async def go(self, _: String) -> None:
        await asyncio.wait_for(self.ping.call(Empty.Request(), timeout=9.5), 60.0)  # stuck: CallsInTime


class CallsShielded(Dialler):
    async def go(self, _: String) -> None:
        await asyncio.shield(self.ping.call(Empty.Request()))  # stuck: CallsShielded


class CallsInATask(Dialler):
    async def go(self, _: String) -> None:
        asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        await asking  # stuck: CallsInATask


class CallsTwoAtOnce(Dialler):
    async def go(self, _: String) -> None:
        await asyncio.gather(self.ping.call(Empty.Request()), self.pong.call(Empty.Request()))  # stuck: CallsTwoAtOnce


class CallsAGroup(Dialler):
    async def go(self, _: String) -> None:
        async with asyncio.TaskGroup() as calls:  # stuck: CallsAGroup
            calls.create_task(self.ping.call(Empty.Request()))
            calls.create_task(self.pong.call(Empty.Request()))


class TakesTheFirst(Dialler):
    """Both are dead."""

    async def go(self, _: String) -> None:
        calls = [asyncio.ensure_future(self.ping.call(Empty.Request())) for _ in range(2)]
        await asyncio.wait(calls, return_when=asyncio.FIRST_COMPLETED)  # stuck: TakesTheFirst


class FollowsAParameter(Dialler):
    speed = Param(1.0)
    applied = False

    @speed.on_change
    async def speed_changed(self, old: float, new: float) -> None:
        await self.ping.call(Empty.Request())  # stuck: FollowsAParameter
        self.applied = True

    async def go(self, _: String) -> None:
        self.speed = 2.0
        while not self.applied:
            await self.clock.sleep(0.1)


class TwoServices(Robot):
    """Ask each other, for ever."""

    left = Client(Empty, "left")
    right = Client(Empty, "right")

    async def go(self, _: String) -> None:
        await self.left.call(Empty.Request())

    @service(Empty, "left")
    async def on_left(self, request: Empty.Request) -> Empty.Response:
        await self.right.call(Empty.Request())
        return Empty.Response()

    @service(Empty, "right")
    async def on_right(self, request: Empty.Request) -> Empty.Response:
        await self.left.call(Empty.Request())  # stuck: TwoServices
        return Empty.Response()


class AnswersInTheGroup(Robot):
    """The service is in no group, but its answer waits for one, as it does in ROS 2."""

    echo = Client(Empty, "echo", group=Robot.motion)

    @service(Empty, "echo")
    async def on_echo(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    async def go(self, _: String) -> None:
        await self.echo.call(Empty.Request())  # stuck: AnswersInTheGroup


class TaskAndService(Dialler):
    """A service waits for a flag that is set by the task that has called it."""

    answered = False
    pung = Client(Empty, "pung")

    @service(Empty, "pung")
    async def on_pung(self, request: Empty.Request) -> Empty.Response:
        while not self.answered:
            await self.clock.sleep(0.05)
        return Empty.Response()

    @task
    async def main(self) -> None:
        await self.pung.call(Empty.Request())  # stuck: TaskAndService
        self.answered = True


class DropsNews(Waiter):
    """What sets the event is not even kept."""

    latest = Group(1, "drop_new")

    @subscription(String, "go", group=latest)
    async def go(self, _: String) -> None:
        await self.arrived.wait()  # stuck: DropsNews

    @subscription(String, "arrive", group=latest)
    async def arrive(self, _: String) -> None:
        self.arrived.set()


class Sends(Planner):
    """Sends its goal outside of the group."""

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        await self.plan.send_goal(Fibonacci.Goal(order=1))


class PlansByFlag(Sends):
    planned = False

    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        while not self.planned and not goal.is_cancel_requested:
            await self.clock.sleep(0.05)  # stuck: PlansByFlag
        return Fibonacci.Result()

    async def arrive(self, _: String) -> None:
        self.planned = True


class PlansByEvent(Sends):
    def __init__(self) -> None:
        super().__init__()
        self.planning = asyncio.Event()

    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.planning.wait()  # stuck: PlansByEvent
        return Fibonacci.Result()

    @timer(0.3, group=Robot.motion)
    async def look(self) -> None:
        self.planning.set()


class PlansByCall(Sends, Dialler):
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.ping.call(Empty.Request())  # stuck: PlansByCall
        return Fibonacci.Result()


class PlansInPairs(Sends):
    """Two slots, one taken by a goal and one by a handler, and both call a service that needs a third."""

    pair = Group(2)
    pung = Client(Empty, "pung")

    @service(Empty, "pung", group=pair)
    async def on_pung(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @action(Fibonacci, "plan", group=pair)
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.clock.sleep(0.1)
        await self.pung.call(Empty.Request())  # stuck: PlansInPairs
        return Fibonacci.Result()

    @subscription(String, "arrive", group=pair)
    async def arrive(self, _: String) -> None:
        await self.clock.sleep(0.1)
        await self.pung.call(Empty.Request())


class AwaitsItsPlan(Planner):
    async def go(self, _: String) -> None:
        async with self.plan.send(Fibonacci.Goal(order=1)) as goal:
            await goal.result()  # stuck: AwaitsItsPlan


class PollsItsPlan(Planner):
    async def go(self, _: String) -> None:
        async with self.plan.send(Fibonacci.Goal(order=1)) as goal:
            while not goal.done:
                await self.clock.sleep(0.05)  # stuck: PollsItsPlan


class PollsThePlanItKeeps(Planner):
    errand: Any = None

    async def go(self, _: String) -> None:
        self.errand = await self.plan.send_goal(Fibonacci.Goal(order=1))
        while not self.errand.done:
            await self.clock.sleep(0.05)  # stuck: PollsThePlanItKeeps


class FollowsItsPlan(Planner):
    async def go(self, _: String) -> None:
        async with self.plan.send(Fibonacci.Goal(order=1)) as goal:
            async for _feedback in goal.feedback():  # stuck: FollowsItsPlan
                pass


class PlansWithinPlans(Robot):
    """A goal that sends another to its own action, which takes one after the other."""

    plan = ActionClient(Fibonacci, "plan")

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        await self.plan.send_goal(Fibonacci.Goal(order=1))

    @action(Fibonacci, "plan", policy="queue")
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        if goal.request.order:
            part = await self.plan.send_goal(Fibonacci.Goal())
            await part.result()  # stuck: PlansWithinPlans
        return Fibonacci.Result()


class AsksBeforeItAccepts(Dialler):
    plan = ActionClient(Fibonacci, "plan")

    async def fits(self, goal: Fibonacci.Goal) -> bool:
        await self.ping.call(Empty.Request())  # stuck: AsksBeforeItAccepts
        return True

    @action(Fibonacci, "plan", accept=fits)
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()

    async def go(self, _: String) -> None:
        await self.plan.send_goal(Fibonacci.Goal(order=1))


class KeepsItsLock(Dialler):
    """The service is in a group of its own, and wants the lock that its caller holds."""

    def __init__(self) -> None:
        super().__init__()
        self.guard = asyncio.Lock()

    @service(Empty, "ping")
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        async with self.guard:  # stuck: KeepsItsLock
            return Empty.Response()

    async def go(self, _: String) -> None:
        async with self.guard:
            await self.ping.call(Empty.Request())


class LocksTwice(Robot):
    """A lock is not to be had twice."""

    def __init__(self) -> None:
        super().__init__()
        self.latch = asyncio.Lock()

    async def go(self, _: String) -> None:
        async with self.latch:
            await self.halt()

    async def halt(self) -> None:
        async with self.latch:  # stuck: LocksTwice
            self.log.info("stopped")


class LocksCrosswise(Robot):
    """Two handlers take two locks, each the other one first."""

    def __init__(self) -> None:
        super().__init__()
        self.left, self.right = asyncio.Lock(), asyncio.Lock()

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        async with self.left:
            await self.clock.sleep(0.1)
            async with self.right:  # stuck: LocksCrosswise
                self.log.info("both")

    @subscription(String, "arrive")
    async def arrive(self, _: String) -> None:
        async with self.right:
            await self.clock.sleep(0.1)
            async with self.left:
                self.log.info("both")


class TakesTwoPermits(Dialler):
    """Both permits are with those who wait for somebody who needs one."""

    def __init__(self) -> None:
        super().__init__()
        self.tickets = asyncio.Semaphore(2)

    @service(Empty, "ping")
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        async with self.tickets:  # stuck: TakesTwoPermits
            return Empty.Response()

    async def go(self, _: String) -> None:
        async with self.tickets, self.tickets:
            await self.ping.call(Empty.Request())


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


class AwaitsAnswersById(Node):
    """A future for each request, in a dictionary; no other code that is read here ends a future."""

    node_name = "robot"
    motion = Group(1)

    def __init__(self) -> None:
        super().__init__()
        self.pending: dict[int, asyncio.Future[None]] = {}

    @subscription(String, "go", group=motion)
    async def go(self, _: String) -> None:
        self.pending[1] = asyncio.get_running_loop().create_future()
        await self.pending[1]  # stuck: AwaitsAnswersById

    @subscription(String, "arrive", group=motion)
    async def arrive(self, _: String) -> None:
        self.pending.pop(1).set_result(None)


class SleepsOnAThread(Robot):
    """Waits in a thread for an event that is set on the loop."""

    def __init__(self) -> None:
        super().__init__()
        self.alarm = threading.Event()

    async def go(self, _: String) -> None:
        await self.offload(self.alarm.wait)  # stuck: SleepsOnAThread

    async def arrive(self, _: String) -> None:
        self.alarm.set()

    async def on_shutdown(self) -> None:
        self.alarm.set()


class TriesAgain(Waiter):
    """Gives up each tenth of a second, to try again."""

    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            with suppress(TimeoutError):
                await asyncio.wait_for(self.arrived.wait(), 0.1)  # stuck: TriesAgain


class Stuck(NamedTuple):
    """A program that cannot go on, and how that is to be told."""

    program: type[Node]
    wanted: str
    blocked: str
    """The handler that cannot run."""
    holder: str
    group: str
    verdict: str
    marker: str


CALLED = "the response of service /ping"
PLANNED = "the result of action /plan"


def stuck(
    program: type[Node],
    wanted: str = "self.there",
    blocked: str = "subscription arrive",
    holder: str = "subscription go",
    group: str = "motion",
    *,
    verdict: str = "LIKELY DEADLOCK",
    marker: str = "",
) -> Any:
    """A case: a program, and how it is to be told."""
    case = Stuck(program, wanted, blocked, holder, group, verdict, f"stuck: {marker or program.__name__}")
    return pytest.param(case, id=program.__name__)


def dead_call(program: type[Node], *expected: str) -> Any:
    """The same for a call or goal, whose deadlock is certain."""
    words = expected or (CALLED, "service on_ping")
    return stuck(program, *words, verdict="DEADLOCK")


@pytest.mark.parametrize(
    "case",
    sample(
        [
            stuck(Waiter, "self.arrived"),
            stuck(EventWithin, "self.arrived", verdict="WAITS IN VAIN"),
            stuck(EventWaitedFor, "self.arrived", verdict="WAITS IN VAIN"),
            stuck(EventTriedFor, "self.arrived", verdict="WAITS IN VAIN"),
            stuck(EventGathered, "self.arrived"),
            stuck(EventPolled, "self.arrived"),
            stuck(TurnsUntilItIsReady, "self.is_ready_now"),
            stuck(EventOfTheNextMessage, "self.arrived", holder="subscription arrive"),
            stuck(DropsNews, "self.arrived", group="latest"),
            stuck(Eater, "self.words"),
            stuck(QueuePolled, "self.words"),
            stuck(Feeder, "self.plates"),
            stuck(SemaphoreAcquired, "self.permits"),
            stuck(Notified, "self.news"),
            stuck(NotifiedFor, "self.news"),
            stuck(Promised, "self.promise"),
            stuck(PromisedByAnotherName, "self.promise"),
            stuck(PromisedInTime, "self.promise", verdict="WAITS IN VAIN"),
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
            stuck(KeepsItsLock, "self.guard", "subscription go", "service on_ping", ""),
            stuck(LocksTwice, "self.latch", "subscription go"),
            stuck(LocksCrosswise, "self.right", "subscription arrive", "subscription go", ""),
            stuck(TakesTwoPermits, "self.tickets", "subscription go", "service on_ping", ""),
            stuck(CountsInAList, "self.seen"),
            stuck(AsksWhoIsReady, "self.ready"),
            stuck(WaitsForAState, "self.mode"),
            stuck(FollowsAPath, "self.spot and self.target"),
            stuck(AwaitsAnswersById, "a part of self.pending"),
            stuck(SleepsOnAThread, "self.alarm"),
            stuck(TriesAgain, "self.arrived"),
            stuck(DrivesByPose, "self.pose"),
            stuck(NamesTheDistance, "self.pose"),
            stuck(TakesThePoseApart, "self.pose"),
            dead_call(CallsThreeDown),
            dead_call(CallsInTime),
            dead_call(CallsShielded),
            dead_call(CallsInATask),
            dead_call(PollsACall),
            dead_call(PollsACallOfItsNodes),
            dead_call(PollsSeveral),
            dead_call(CallsTwoAtOnce),
            dead_call(CallsAGroup),
            dead_call(TakesTheFirst),
            dead_call(AnswersInTheGroup, "the response of service /echo", "reply echo"),
            dead_call(TwoServices, "the response of service /left", "service on_left", "service on_right", ""),
            stuck(FollowsAParameter, CALLED, "service on_ping", "speed_changed", ""),
            stuck(TaskAndService, "the response of service /pung", "service on_pung", "task main", ""),
            stuck(PlansByFlag, "self.planned", holder="action on_plan"),
            stuck(PlansByEvent, "self.planning", "timer look", "action on_plan"),
            dead_call(PlansByCall, CALLED, "service on_ping", "action on_plan"),
            dead_call(
                PlansInPairs,
                "the response of service /pung",
                "service on_pung",
                "action on_plan",
                "pair",
            ),
            dead_call(AwaitsItsPlan, PLANNED, "action on_plan"),
            dead_call(PollsItsPlan, PLANNED, "action on_plan"),
            dead_call(PollsThePlanItKeeps, PLANNED, "action on_plan"),
            dead_call(FollowsItsPlan, PLANNED, "action on_plan"),
            dead_call(PlansWithinPlans, PLANNED, "action on_plan", "action on_plan", ""),
            dead_call(
                AsksBeforeItAccepts,
                CALLED,
                "service on_ping",
                "service on_plan send_goal",
                "",
            ),
        ]
    ),
)
async def test_a_program_that_cannot_go_on(graph: Graph, caplog: Caplog, case: Stuck) -> None:
    """It is told once, within a second: who holds what and waits where, for whom that cannot run."""
    graph.deadlock = "report"
    graph.waits_outside = False  # one of them waits on a thread for what cannot happen
    await graph.start(case.program())
    await say(graph, "/go", "/arrive", "/arrive")
    await graph.clock.advance(1.0)
    [text] = [*reports(caplog), *in_vain(caplog)]

    told = flat(text)
    assert told.startswith(f"{case.verdict}: ")
    holds = f" holds group '{case.group}' and" if case.group else ""
    [_, after] = told.split(f" {case.holder} of /robot{holds} waits for {case.wanted} {at(case.marker)}")
    assert f"{case.blocked} of /robot " in after.partition(" -> ")[2].partition(" -> ")[0]
    assert "ends it:" in told or case.program is TaskAndService
    assert [line for line in text.splitlines() if len(line) > 100] == []
    await graph.clock.advance(8.0)
    assert [*reports(caplog), *in_vain(caplog)] == [text]
    assert not cleared(caplog)


class LocksByHand(Dialler):
    """One releases what another takes by `with`."""

    def __init__(self) -> None:
        super().__init__()
        self.bolt = asyncio.Lock()

    async def go(self, _: String) -> None:
        await self.bolt.acquire()
        await self.ping.call(Empty.Request())
        self.bolt.release()

    @service(Empty, "ping")
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        async with self.bolt:  # stuck: LocksByHand
            return Empty.Response()


async def test_a_lock_that_is_released_by_hand(graph: Graph, caplog: Caplog) -> None:
    """Who has taken it is known by who will release it."""
    graph.deadlock = "report"
    await graph.start(LocksByHand())
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    assert at("stuck: LocksByHand") in the_report(caplog)


class OnlyTimers(Node):
    """In no group, and nothing is queued; but periods are skipped."""

    node_name = "robot"

    def __init__(self) -> None:
        super().__init__()
        self.left_hand, self.right_hand = asyncio.Lock(), asyncio.Lock()

    @timer(1.0)
    async def juggle(self) -> None:
        async with self.left_hand:
            await self.clock.sleep(0.3)
            async with self.right_hand:  # stuck: OnlyTimers
                self.log.info("juggled")

    @timer(1.0)
    async def clap(self) -> None:
        async with self.right_hand:
            await self.clock.sleep(0.3)
            async with self.left_hand:
                self.log.info("clapped")


async def test_timers_that_wait_for_each_other(graph: Graph, caplog: Caplog) -> None:
    """The next period makes somebody look."""
    graph.deadlock = "report"
    await graph.start(OnlyTimers())
    await graph.clock.advance(3.0)

    assert at("stuck: OnlyTimers") in the_report(caplog)


class OnlyTasks(Node):
    """Two tasks, each of which waits for what the other sets then; nobody calls, and nothing is queued."""

    node_name = "robot"

    def __init__(self) -> None:
        super().__init__()
        self.mapped, self.localized = asyncio.Event(), asyncio.Event()

    @task
    async def build(self) -> None:
        await self.clock.sleep(3.0)
        await self.localized.wait()  # stuck: OnlyTasks
        self.mapped.set()

    @task
    async def localize(self) -> None:
        await self.clock.sleep(5.0)
        await self.mapped.wait()
        self.localized.set()


async def test_tasks_that_wait_for_each_other(graph: Graph, caplog: Caplog) -> None:
    """Nobody need call for them to be looked at."""
    graph.deadlock = "report"
    await graph.start(OnlyTasks())
    await graph.clock.advance(5.0)
    assert reports(caplog) == []
    await graph.clock.advance(2.5)

    assert at("stuck: OnlyTasks") in the_report(caplog)


class SlotOfAnother(Waiter):
    """Comes back to its group to set what the handler waits for that has taken its place."""

    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.clock.sleep(0.2)
        self.arrived.set()

    async def arrive(self, _: String) -> None:
        await self.arrived.wait()  # stuck: SlotOfAnother


async def test_a_run_that_cannot_come_back_to_its_group(graph: Graph, caplog: Caplog) -> None:
    """It is found without anything else that waits, and so is the handler that holds its slot."""
    graph.deadlock = "report"
    await graph.start(SlotOfAnother())
    await say(graph, "/go", "/arrive")
    await graph.clock.advance(2.0)

    assert at("stuck: SlotOfAnother") in the_report(caplog)


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


@pytest.mark.parametrize(
    ("program", "words", "says"),
    [
        (AwaitsItsPlan, "for 0.00 s", False),
        (PlansWithinPlans, "Group(None)", False),
        (PlansWithinPlans, "policy='parallel'", True),
        (EventWithin, "times out in 4.5 s", True),
        (CallsInTime, "times out in 9.", True),
    ],
)
async def test_what_a_report_says_and_what_not(
    graph: Graph, caplog: Caplog, program: type[Node], words: str, says: bool
) -> None:
    """How long it has lasted and will, and advice that helps."""
    graph.deadlock = "report"
    await graph.start(program())
    await say(graph, "/go", "/arrive")
    await graph.clock.advance(1.0)

    [text] = [*reports(caplog), *in_vain(caplog)]
    assert (words in flat(text)) is says
