"""Virtual time and a seeded network, and invariants of groups, actions and the deadlock search under them."""

from __future__ import annotations

import asyncio
import logging
from typing import Any

import pytest

from graphflow import (
    ActionClient,
    CallError,
    Client,
    GoalError,
    Group,
    Node,
    Publisher,
    action,
    service,
    subscription,
    timer,
)
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.runtime.node_core import core_of
from graphflow.testing.simulation import Standstill, World, simulate
from tests.cases import count, slow


class Counter(Node):
    """Counts ten times a second."""

    count = Publisher(Int32, "count")
    n = 0

    @timer(0.1)
    async def tick(self) -> None:
        self.n += 1
        self.count.publish(Int32(data=self.n))


class Hearer(Node):
    """Record messages and their times."""

    def __init__(self) -> None:
        super().__init__()
        self.heard: list[tuple[int, float]] = []

    @subscription(Int32, "count", 1000)
    async def hear(self, message: Int32) -> None:
        self.heard.append((message.data, asyncio.get_running_loop().time()))


async def listen(world: World) -> list[tuple[int, float]]:
    await world.start(Counter(), hearer := Hearer())
    await asyncio.sleep(100.0)
    return hearer.heard


@slow
def test_time_passes_at_once_and_the_same_way_every_time() -> None:
    """A seed decides everything; another seed decides otherwise."""
    first = simulate(listen, 1, delay=(0.0, 0.05), loss=0.2)
    assert first == simulate(listen, 1, delay=(0.0, 0.05), loss=0.2)
    assert first != simulate(listen, 2, delay=(0.0, 0.05), loss=0.2)
    assert 700 < len(first) < 900


def test_a_link_keeps_its_order_unless_it_does_not() -> None:
    """Messages of one publisher overtake each other only if they may."""
    for reorders in (False, True):
        heard = [n for n, _ in simulate(listen, 3, delay=(0.0, 0.5), reorders=reorders)]
        assert (heard == sorted(heard)) is not reorders


def test_nothing_to_wait_for_is_an_error() -> None:
    """A story that waits for an impossible event ends at once."""

    async def story(world: World) -> None:
        await asyncio.Event().wait()

    with pytest.raises(Standstill):
        simulate(story)


class Worker(Node):
    """Two handlers of one group, which take their time."""

    work = Group(2)

    def __init__(self, random: Any) -> None:
        super().__init__("worker")
        self.random, self.now, self.most, self.runs = random, 0, 0, 0

    async def run(self) -> None:
        self.now += 1
        self.runs += 1
        self.most = max(self.most, self.now)
        try:
            await self.clock.sleep(self.random.uniform(0, 0.3))
            if self.random.random() < 0.3:
                try:
                    async with self.group.released():
                        self.now -= 1
                        await self.clock.sleep(self.random.uniform(0, 0.3))
                finally:
                    self.now += 1
                    self.most = max(self.most, self.now)
            if self.random.random() < 0.1:
                raise ValueError("now and then")
        finally:
            self.now -= 1

    @subscription(Int32, "count", 5, group=work, on_error="log")
    async def one(self, _: Int32) -> None:
        await self.run()

    @timer(0.15, group=work, on_error="log")
    async def two(self) -> None:
        await self.run()

    @service(Trigger, "three", group=work)
    async def three(self, _: Trigger.Request) -> Trigger.Response:
        await self.run()
        return Trigger.Response(success=True)


@slow
@pytest.mark.parametrize("seed", range(count(few=8, full=20)))
def test_a_group_never_has_more_runs_than_slots(seed: int) -> None:
    """At the end all slots are free, whatever the order of arrivals, failures and releases."""

    async def story(world: World) -> None:
        await world.start(Counter(), worker := Worker(world.random))
        await asyncio.sleep(30.0)
        assert worker.most == 2
        assert worker.runs > 100
        await core_of(worker).stop()
        assert (worker.now, core_of(worker).groups.by_name["work"].running) == (0, 0)

    logging.disable()
    try:
        simulate(story, seed, delay=(0.0, 0.2), loss=0.1, reorders=True)
    finally:
        logging.disable(logging.NOTSET)


class Rabbits(Node):
    """Counts, fails now and then, and takes its time to clean up."""

    def __init__(self, random: Any) -> None:
        super().__init__("rabbits")
        self.random, self.bodies = random, 0

    @action(Fibonacci, "fibonacci", policy="preempt")
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        self.bodies += 1
        assert self.bodies == 1
        try:
            for n in range(goal.request.order):
                await self.clock.sleep(self.random.uniform(0, 0.2))
                goal.feedback(Fibonacci.Feedback(sequence=[n]))
            if self.random.random() < 0.2:
                raise ValueError("now and then")
            return Fibonacci.Result(sequence=[goal.request.order])
        finally:
            await self.clock.sleep(self.random.uniform(0, 0.1))
            self.bodies -= 1


class Farmer(Node):
    fibonacci = ActionClient(Fibonacci, "fibonacci")


@pytest.mark.parametrize("seed", range(count(few=10, full=30)))
def test_every_goal_ends_once_and_nobody_waits_for_ever(seed: int) -> None:
    """With a server that fails, pre-empts, is killed and comes back, on a network that loses a tenth of everything."""

    async def story(world: World) -> None:
        random, goals = world.random, list[Any]()
        server = Rabbits(random)
        await world.start(server, farmer := Farmer())

        async def one() -> None:
            await asyncio.sleep(random.uniform(0, 10))
            try:
                async with farmer.fibonacci.send(Fibonacci.Goal(order=random.randrange(8)), timeout=2.0) as goal:
                    try:
                        if random.random() < 0.5:
                            await goal.result(timeout=random.uniform(0, 1))
                        else:
                            await asyncio.sleep(random.uniform(0, 1))
                    except (GoalError, TimeoutError):
                        pass
            except (CallError, GoalError):
                return
            goals.append(goal)

        async with asyncio.timeout(60.0), asyncio.TaskGroup() as group:
            for _ in range(20):
                group.create_task(one())
            await asyncio.sleep(random.uniform(2, 8))
            await world.kill(server)
            await asyncio.sleep(random.uniform(0, 2))
            await world.start(Rabbits(random))
        # A goal whose cancelling was lost on the way may go on a while.
        await asyncio.sleep(120.0)
        assert all(goal.done for goal in goals)
        assert len(goals) > 3

    logging.disable()
    try:
        simulate(story, seed, delay=(0.0, 0.05), loss=0.1)
    finally:
        logging.disable(logging.NOTSET)


class Neighbour(Node):
    """Call the other node, in the group of its own service or in another."""

    everything = Group(1)
    apart = Group(1)
    other = Client(Trigger, "other")
    asked = 0

    @timer(1.0, group=everything, on_error="log")
    async def ask(self) -> None:
        await self.clock.sleep(0.1)
        await self.other.call(Trigger.Request())
        self.asked += 1

    @service(Trigger, "~/answer", group=everything)
    async def answer(self, _: Trigger.Request) -> Trigger.Response:
        await self.clock.sleep(0.01)
        return Trigger.Response(success=True)


class Polite(Neighbour):
    """Answers in a group of its own."""

    @service(Trigger, "~/answer", group=Neighbour.apart)
    async def answer(self, _: Trigger.Request) -> Trigger.Response:
        await self.clock.sleep(0.01)
        return Trigger.Response(success=True)


@slow
@pytest.mark.parametrize("seed", range(count(few=8, full=20)))
@pytest.mark.parametrize("cls", [Neighbour, Polite])
def test_a_ring_is_reported_once_and_legal_calls_never(
    seed: int, cls: type[Neighbour], caplog: pytest.LogCaptureFixture
) -> None:
    """However long things take on their way: within half a second of the ring's closing, and by one of the two."""

    async def story(world: World) -> None:
        left = cls("left", remap=["other:=/right/answer"])
        right = (
            Polite("right", remap=["other:=/left/answer"])
            if cls is Polite
            else cls("right", remap=["other:=/left/answer"])
        )
        await world.start(left, right)
        await asyncio.sleep(8.0)

    simulate(story, seed, delay=(0.0, 0.02), deadlock="report")
    reports = [m for m in caplog.messages if "DEADLOCK" in m]
    if cls is Polite:
        assert reports == []
    else:
        assert len(reports) == 1
        assert reports[0].startswith("DEADLOCK: 2 callbacks wait for each other in a ring")
