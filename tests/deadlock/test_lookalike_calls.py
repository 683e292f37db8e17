"""Programs that wait for a call or a goal, look deadlocked and go on: nothing is said of them."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

import pytest

from graphflow import (
    ActionClient,
    CallError,
    CallTimeout,
    Client,
    GoalCanceled,
    Group,
    Node,
    ServerBusy,
    action,
    service,
    subscription,
    timer,
)
from graphflow.interface import DeadlockPolicy, GroupChange, WhenFull
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import explained
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.cases import sample, slow
from tests.deadlock.cast import Caplog, Dialler, Planner, Robot, reports, say
from tests.deadlock.lookalikes import goes_on, legal
from tests.runtime.cast import Log


class EndsWithAGoal(Robot):
    """The state of a goal changes without anybody assigning it."""

    plan = ActionClient(Fibonacci, "plan")
    trip: Any = None

    @action(Fibonacci, "plan")
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.clock.sleep(3.0)
        return Fibonacci.Result()

    async def go(self, _: String) -> None:
        self.trip = await self.plan.send_goal(Fibonacci.Goal(order=1))
        while not self.trip.done:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        await self.trip.cancel()


class PollsWhatAnotherCancels(Dialler):
    """It ends with an error, which is an end."""

    async def go(self, _: String) -> None:
        self.asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        while not self.asking.done():
            await self.clock.sleep(0.05)

    @timer(3.0)
    def give_up(self) -> None:
        self.asking.cancel()


class PollsWhatItGaveAway(Dialler):
    def __init__(self) -> None:
        super().__init__()
        self.begun: list[asyncio.Task[Any]] = []

    async def go(self, _: String) -> None:
        asking = asyncio.create_task(self.ping.call(Empty.Request()))
        self.begun.append(asking)
        while not asking.done():
            await self.clock.sleep(0.05)

    @timer(3.0)
    def give_up(self) -> None:
        for asking in self.begun:
            asking.cancel()


class PollsUntilItIsReplaced(Dialler):
    task_of_go: asyncio.Task[Any] | None = None

    async def go(self, _: String) -> None:
        self.task_of_go = asyncio.create_task(self.ping.call(Empty.Request()))
        while self.task_of_go and not self.task_of_go.done():
            await self.clock.sleep(0.05)

    @timer(3.0)
    def give_up(self) -> None:
        self.task_of_go = None


class PollsWhatTakesItsTime(Dialler):
    async def go(self, _: String) -> None:
        walking = asyncio.create_task(self.clock.sleep(3.0))
        while not walking.done():
            await self.clock.sleep(0.05)


class PollsTheFirstOfTwo(Dialler):
    """One of them is never answered, which does not matter."""

    async def go(self, _: String) -> None:
        asking = [asyncio.create_task(client.call(Empty.Request())) for client in (self.ping, self.pong)]
        while not any(each.done() for each in asking):
            await self.clock.sleep(0.1)
        await self.clock.sleep(2.0)
        for each in asking:
            each.cancel()


class PollsAndCancels(Dialler):
    """Counts, and loses patience."""

    async def go(self, _: String) -> None:
        asking = asyncio.create_task(self.ping.call(Empty.Request()))
        turns = 0
        while not asking.done():
            turns += 1
            if turns == 30:
                asking.cancel()
            await self.clock.sleep(0.1)


class CancelsItsTaskFromOutside(Dialler):
    """A handler in no group ends the wait."""

    calling: asyncio.Task[Any] | None = None

    async def go(self, _: String) -> None:
        self.calling = asyncio.create_task(self.ping.call(Empty.Request()))
        with suppress(asyncio.CancelledError):
            await self.calling

    @timer(3.0)
    def lose_patience(self) -> None:
        if self.calling is not None:
            self.calling.cancel()


class CancelsItsGoalFromOutside(Planner):
    errand: Any = None

    async def go(self, _: String) -> None:
        self.errand = await self.plan.send_goal(Fibonacci.Goal(order=1))
        with suppress(GoalCanceled):
            await self.errand.result()

    @timer(3.0)
    async def lose_patience(self) -> None:
        if self.errand is not None and not self.errand.done:
            await self.errand.cancel()


class CancelsWhateverItHasBegun(Dialler):
    def __init__(self) -> None:
        super().__init__()
        self.calls: dict[int, asyncio.Task[Any]] = {}

    async def go(self, _: String) -> None:
        self.calls[1] = asyncio.create_task(self.ping.call(Empty.Request()))
        with suppress(asyncio.CancelledError):
            await self.calls[1]

    @timer(3.0)
    def lose_patience(self) -> None:
        for call in self.calls.values():
            call.cancel()


class PushesItselfOut(Robot):
    """The call that comes back is newer work of a group that cancels for it."""

    latest = Group(1, "cancel_running")
    there = Client(Empty, "there")

    @subscription(String, "go", group=latest)
    async def go(self, _: String) -> None:
        await self.there.call(Empty.Request(), timeout=None)

    @service(Empty, "back", group=latest)
    async def on_back(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


@slow
@pytest.mark.parametrize(
    "program",
    sample(
        [
            legal(PollsWhatAnotherCancels),
            legal(PollsWhatItGaveAway),
            legal(PollsUntilItIsReplaced),
            legal(PollsWhatTakesItsTime),
            legal(PollsTheFirstOfTwo),
            legal(PollsAndCancels),
            legal(CancelsItsTaskFromOutside),
            legal(CancelsItsGoalFromOutside),
            legal(CancelsWhateverItHasBegun),
            legal(EndsWithAGoal),
        ]
    ),
)
async def test_a_program_that_goes_on(graph: Graph, caplog: Caplog, program: type[Robot]) -> None:
    """Nothing is ever said of it, though it waits for seconds while others of its group queue."""
    await goes_on(graph, caplog, program())


class CallsWithoutItsSlot(Dialler):
    async def go(self, _: String) -> None:
        async with self.group.released():
            await self.ping.call(Empty.Request())


@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_a_call_with_the_slot_released(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """It is answered, and the handler comes back."""
    graph.deadlock = policy
    robot = CallsWithoutItsSlot()
    await graph.start(robot)
    await say(graph, "/go")
    await graph.clock.advance(1.0)

    assert robot.statistics()["service /ping"]["runs"] == 1
    assert robot.motion.running == 0
    assert reports(caplog) == []


@pytest.mark.parametrize(
    ("when_full", "outcome"), [("drop_new", ServerBusy), ("cancel_running", asyncio.CancelledError)]
)
@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_a_call_into_its_own_group_that_does_not_queue(
    graph: Graph, caplog: Caplog, when_full: WhenFull, outcome: type[BaseException], policy: DeadlockPolicy
) -> None:
    """The call is refused, or the caller makes room for it: either way nobody is stuck."""
    graph.deadlock = policy
    outcomes = Log()

    class Cautious(Dialler):
        async def go(self, _: String) -> None:
            try:
                await self.ping.call(Empty.Request())
            except BaseException as error:
                outcomes(type(error))
                raise

    robot = Cautious(concurrency={"motion": GroupChange(when_full=when_full)})
    await graph.start(robot)
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    assert outcomes == [outcome]
    assert robot.motion.running == 0
    assert reports(caplog) == []


class GivesUp(Node):
    """Waits a second for an answer, and then does something else, in the group that the answer needs."""

    work = Group(1)
    inspect = Client(Empty, "inspect")

    @subscription(String, "go", group=work)
    async def ask(self, _: String) -> None:
        try:
            await self.inspect.call(Empty.Request(), timeout=1.0)
        except CallTimeout:
            await self.clock.sleep(3.0)

    @service(Empty, "answer", group=work)
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


class Inspector(Node):
    """Takes two seconds before it asks back."""

    answer = Client(Empty, "answer")

    def __init__(self) -> None:
        super().__init__()
        self.outcomes = Log()

    @service(Empty, "inspect")
    async def on_inspect(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(2.0)
        try:
            self.outcomes(await self.answer.call(Empty.Request()))
        except CallError as error:
            self.outcomes(type(error))
        return Empty.Response()


@pytest.mark.parametrize(
    "policy",
    [
        "report",
        "raise",
    ],
)
async def test_a_caller_that_has_given_up(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """What was called for it may call it: it waits no more, and will give its slot back."""
    graph.deadlock = policy
    inspector = Inspector()
    await graph.start(GivesUp(), inspector)
    await say(graph, "/go")
    await graph.clock.advance(6.0)

    assert inspector.outcomes == [Empty.Response()]
    assert reports(caplog) == []


class TakesTheFirstFuture(Dialler):
    """One of two is dead, and the test ends the other."""

    def __init__(self) -> None:
        super().__init__()
        self.living: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    async def go(self, _: String) -> None:
        asking: asyncio.Future[Any] = asyncio.ensure_future(self.ping.call(Empty.Request()))
        await asyncio.wait([asking, self.living], return_when=asyncio.FIRST_COMPLETED)
        asking.cancel()


class GathersAFuture(TakesTheFirstFuture):
    async def go(self, _: String) -> None:
        asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        try:
            await asyncio.gather(asking, self.living)
        finally:
            asking.cancel()


@pytest.mark.parametrize(
    "program",
    [legal(TakesTheFirstFuture), legal(GathersAFuture)],
)
async def test_what_is_about_to_go_on(graph: Graph, program: type[TakesTheFirstFuture]) -> None:
    """A wait that is over is none, though its handler has not had its turn of the loop yet."""
    graph.deadlock = "report"
    robot = program()
    await graph.start(robot)
    await say(graph, "/go")
    if program is GathersAFuture:
        robot.living.set_exception(ValueError())
    else:
        robot.living.set_result(None)
    for _ in range(5):
        picture = robot.context.search.snapshot.take()
        assert explained(picture, deadlocked(picture)) == []
        await asyncio.sleep(0)
    assert robot.motion.running == 0


class AsksBack(Node):
    back = Client(Empty, "back")

    @service(Empty, "there")
    async def on_there(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(3.0)
        return await self.back.call(Empty.Request(), timeout=None)


async def test_a_call_that_comes_back_and_cancels_who_waits_for_it(graph: Graph, caplog: Caplog) -> None:
    """With the policy that fails hopeless calls: this one is not."""
    graph.deadlock = "raise"
    robot = PushesItselfOut()
    await graph.start(robot, AsksBack("other"))
    await say(graph, "/go")
    await graph.clock.advance(4.0)

    assert reports(caplog) == []
    assert "Error" not in caplog.text
    assert not any(runner.active for runner in core_of(robot).runners)


class AlsoServes(Node):
    """Another server of the service."""

    @service(Empty, "ping")
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(2.0)
        return Empty.Response()


class CallsOneOfTwo(Dialler):
    async def go(self, _: String) -> None:
        await self.ping.call(Empty.Request())


@pytest.mark.parametrize("policy", ["raise", "report"])
async def test_a_call_that_another_server_answers(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """One of the two needs a slot that the caller holds."""
    graph.deadlock = policy
    robot = CallsOneOfTwo()
    await graph.start(robot, AlsoServes("other"))
    await say(graph, "/go")
    await graph.clock.advance(3.0)

    assert reports(caplog) == []
    assert "Error" not in caplog.text
    assert not robot.motion.running
