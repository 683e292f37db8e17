"""Programs whose calls and goals cannot end, as students write them: each is explained, with the right line."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import ActionClient, Client, Group, Node, Param, action, service, subscription, task, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from tests.cases import sample, slow
from tests.deadlock.cast import (
    Caplog,
    Dialler,
    EventWithin,
    Planner,
    PollsACall,
    PollsACallOfItsNodes,
    PollsSeveral,
    Robot,
    at,
    in_vain,
    reports,
    say,
    the_report,
)
from tests.deadlock.deadlocked import CALLED, PLANNED, Stuck, cannot_go_on, dead_call, stuck
from tests.flat import flat


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


@slow
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


@slow
@pytest.mark.parametrize(
    "case",
    sample(
        [
            stuck(KeepsItsLock, "self.guard", "subscription go", "service on_ping", ""),
            stuck(TakesTwoPermits, "self.tickets", "subscription go", "service on_ping", ""),
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
            stuck(
                TaskAndService, "the response of service /pung", "service on_pung", "task main", "", has_remedy=False
            ),
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
    await cannot_go_on(graph, caplog, case)


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
