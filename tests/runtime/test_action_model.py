"""Actions against a model: whatever clients, servers and the network do, every goal ends once, and as it should.

Programs of steps run in a simulation. The hooks of the server's own user tell what its bodies do; from that a `Life`
knows through which states its goal must have gone and with what it must end, and everybody else is held to it.
"""

from __future__ import annotations

import asyncio
from asyncio import CancelledError
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graphflow import CallError, Client, GoalCanceled, GoalRejected, Group, Node, action, service
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.testing.simulation import World, simulate
from tests.cases import cases, count, limit, slow
from tests.runtime.action_model import (
    ACCEPTED,
    BARE,
    EXECUTING,
    FOLLOW,
    SUCCEEDED,
    Asker,
    Doer,
    Model,
    Plan,
    Setting,
    watched,
)
from tests.runtime.action_programs import SETTINGS, STEPS, Step, play

CASES = count(few=30, full=180)
"""Programs that are tried."""


@slow
@limit(CASES)
@cases(CASES)
@given(SETTINGS, st.lists(STEPS, min_size=8, max_size=40))
def test_against_the_model(setting: Setting, steps: list[Step]) -> None:
    """What servers, clients and bystanders see of each goal is what the model says, at every step of every program."""
    play(setting, steps)


# By hand


@slow
def test_a_thousand_preemptions() -> None:
    """By three clients over a slow network: never two bodies at once, however they end, and the newest goal wins."""
    model = Model(Setting("preempt", None, "continue", 0.05, 0.0, False, 0))

    async def story(world: World) -> None:
        askers, random = [Asker(f"asker_{n}", **BARE) for n in range(3)], world.random
        await world.start(doer := Doer(model), *askers)
        async with asyncio.TaskGroup() as group:
            for n in range(1000):
                how: Any = random.choice(("ends", "cleans up", "goes on", "returns", "aborts", "fails"))
                life = model.new(Plan((0.1, 0.1), "returns", how))
                group.create_task(askers[n % 3].do.send_goal(Fibonacci.Goal(order=life.n)))
                await asyncio.sleep(random.choice((0.0, 0.0, 0.05, 3.0)))
        await asyncio.sleep(5.0)

        assert model.faults == []
        assert [life.path for life in doer.book.lives] == [life.should_be() for life in doer.book.lives]
        assert doer.book.lives[-1].path[-1] is SUCCEEDED
        assert len(doer.book.lives) == 1000
        assert len(doer.book.bodies) > 200
        assert all(life.cancels == life.must_stop for life in doer.book.bodies)

    with watched(model):
        simulate(story, 4, delay=(0.0, 0.05))


class Stuck(Node):
    """Bodies of order 1 ask a service of their own group, which cannot answer while they wait."""

    work = Group(1)
    asking = Client(Trigger, "answer")

    @service(Trigger, "answer", group=work)
    async def answer(self, _: Trigger.Request) -> Trigger.Response:
        return Trigger.Response()

    @service(Trigger, "hold", group=work)
    async def hold(self, _: Trigger.Request) -> Trigger.Response:
        await self.clock.sleep(3.0)
        return Trigger.Response()

    @action(Fibonacci, "do", group=work, policy="queue")
    async def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        goal.partial = Fibonacci.Result(sequence=[1])
        if goal.request.order == 1:
            await self.asking.call(Trigger.Request(), timeout=None)
        return Fibonacci.Result(sequence=[2])


def test_cancelling_in_a_deadlock(caplog: pytest.LogCaptureFixture) -> None:
    """It is answered while the group is deadlocked, for the goal that waits and for the one that holds the slot."""

    async def story(world: World) -> None:
        await world.start(Stuck(), asker := Asker())
        first, second = [await asker.do.send_goal(Fibonacci.Goal(order=1)) for _ in range(2)]
        await asyncio.sleep(5.0)
        assert [first.status, second.status] == [EXECUTING, ACCEPTED]
        assert "DEADLOCK" in caplog.text
        async with asyncio.timeout(0.5):
            for goal, numbers in ((second, []), (first, [1])):
                assert await goal.cancel()
                with pytest.raises(GoalCanceled) as caught:
                    await goal.result()
                assert list(caught.value.result.sequence) == numbers  # type: ignore[attr-defined]
            third = await asker.do.send_goal(Fibonacci.Goal(order=2))
            assert list((await third.result()).sequence) == [2]

    simulate(story, 1, delay=(0.0, 0.02), deadlock="report")


def test_cancelling_before_execution_begins() -> None:
    """A goal whose group is busy with something else is CANCELED at once, and its body never runs."""

    async def story(world: World) -> None:
        await world.start(stuck := Stuck(), asker := Asker())
        held = asyncio.create_task(asker.create_client(Trigger, "hold").call(Trigger.Request()))
        await asyncio.sleep(0.1)
        goal = await asker.do.send_goal(Fibonacci.Goal(order=2))
        await asyncio.sleep(1.0)
        assert goal.status is ACCEPTED
        async with asyncio.timeout(0.2):
            assert await goal.cancel()
            with pytest.raises(GoalCanceled):
                await goal.result()
        await held
        await asyncio.sleep(1.0)
        assert stuck.statistics()["action /do"] == {"runs": 0, "errors": 0, "active": 0, "waiting": 0}
        assert stuck.statistics()["group work"]["running"] == 0

    simulate(story, 2, delay=(0.0, 0.02))


@slow
def test_cancelling_in_a_flood_of_feedback() -> None:
    """A body that tells more than its client can read is cancelled as any other; the oldest feedback is dropped."""

    class Flood(Node):
        @action(Fibonacci, "do")
        async def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            n = 0
            while True:
                for _ in range(100):
                    goal.feedback(Fibonacci.Feedback(sequence=[n := n + 1]))
                goal.partial = Fibonacci.Result(sequence=[n])
                await self.clock.sleep(0.001)

    async def story(world: World) -> None:
        await world.start(Flood(), asker := Asker())
        goal, read = await asker.do.send_goal(Fibonacci.Goal()), list[int]()

        async def slowly() -> None:
            async for feedback in goal.feedback():
                read.append(feedback.sequence[0])
                await asyncio.sleep(0.001)

        reading = asyncio.create_task(slowly())
        await asyncio.sleep(0.05)
        async with asyncio.timeout(0.05):
            assert await goal.cancel()
            with pytest.raises(GoalCanceled) as caught:
                await goal.result()
        await reading
        assert caught.value.result.sequence[0] >= 4000  # type: ignore[attr-defined]
        assert read == sorted(read)
        assert goal.dropped > 1000

    simulate(story, 3, delay=(0.0, 0.005))


@pytest.mark.parametrize("decides", [0.5, 0.9])
def test_giving_up_before_acceptance(decides: float) -> None:
    """Whoever stops waiting while the server decides has sent nothing: no goal is accepted."""
    model = Model(Setting("queue", None, "continue", 0.0, 0.0, False, 0))

    async def story(world: World) -> None:
        await world.start(doer := Doer(model), asker := Asker())
        goals = [Fibonacci.Goal(order=model.new(Plan(decides=decides)).n) for _ in range(2)]
        sending = asyncio.create_task(asker.do.send_goal(goals[0]))
        await asyncio.sleep(0.2)
        sending.cancel()
        with pytest.raises(CancelledError):
            await sending
        with pytest.raises(CallError):
            await asker.do.send_goal(goals[1], timeout=0.3)
        await asyncio.sleep(5.0)
        assert doer.book.lives == []
        assert model.faults == []
        assert not asker.do._goals

    with watched(model):
        simulate(story)


def test_two_goals_decided_at_the_same_time() -> None:
    """Only one of them is accepted where goals are rejected while another is under way."""
    model = Model(Setting("reject", None, "continue", 0.0, 0.0, False, 0))

    async def story(world: World) -> None:
        await world.start(doer := Doer(model), asker := Asker())
        plans = [Plan((1.0,), decides=decides) for decides in (0.5, 0.7)]
        sending = [asker.do.send_goal(Fibonacci.Goal(order=model.new(plan).n)) for plan in plans]
        _, second = await asyncio.gather(*sending, return_exceptions=True)
        await asyncio.sleep(5.0)
        assert isinstance(second, GoalRejected)
        assert [life.path for life in doer.book.lives] == [[ACCEPTED, EXECUTING, SUCCEEDED]]
        assert model.faults == []

    with watched(model):
        simulate(story)


@slow
def test_states_that_overtake_each_other() -> None:
    """A client never sees a goal go back, from CANCELING to EXECUTING."""
    model = Model(Setting("parallel", None, "continue", 0.3, 0.0, True, 0))

    async def story(world: World) -> None:
        await world.start(Doer(model), asker := Asker())
        await asyncio.sleep(1.0)
        goal = await asker.do.send_goal(Fibonacci.Goal(order=model.new(Plan(ends="never")).n))
        await goal.cancel()
        await asyncio.sleep(1.0)

    with watched(model):
        for seed in range(20):
            model.lives.clear()
            simulate(story, seed, delay=(0.0, 0.3), reorders=True)
            path = model.seen[1].path
            assert all(after in FOLLOW[before] for before, after in zip(path, path[1:], strict=False))


def test_calls_where_messages_overtake_each_other() -> None:
    """A server that is alive is not lost."""

    async def story(world: World) -> None:
        await world.start(Stuck(), asker := Asker())
        calls = [asker.create_client(Trigger, "answer").call(Trigger.Request()) for _ in range(20)]
        await asyncio.gather(*calls)

    simulate(story, 1, delay=(0.0, 0.1), reorders=True)
