"""Races of goals, clients and servers that end: no goal is lost unnoticed, and no error stays in the background."""

from __future__ import annotations

import asyncio
import gc
import threading
import warnings
from asyncio import CancelledError
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

from graphflow import GoalLost, GoalRejected, Node, Publisher, Subscription, action
from graphflow.msgs.action_msgs.srv import CancelGoal
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.testing.simulation import World, simulate
from tests.cases import slow
from tests.runtime.action_model import CANCELED, EXECUTING, LOST, RULES, Asker, Operator, SendGoal, now


class Cleaner(Node):
    """Works until it is cancelled, and takes its time to clean up."""

    def __init__(self, takes: float = 1.0, **options: Any) -> None:
        super().__init__()
        self.takes, self.cancels, self.cleaned = takes, 0, 0
        self.at_work = self.create_action_server(Fibonacci, "do", self.body, **options)

    async def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        clock = self.clock
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            self.cancels += 1
            try:
                if self.takes:
                    await clock.sleep(self.takes)
                self.cleaned += 1
            except CancelledError:
                self.cancels += 1
                raise
        return Fibonacci.Result()


async def test_a_newer_goal_that_is_cancelled_at_once(graph: Graph) -> None:
    """A goal that is cancelled before anything comes of it pre-empts nobody."""
    await graph.start(cleaner := Cleaner(0.0, policy="preempt"), asker := Asker(), operator := Operator(lambda _: None))
    older = await asker.do.send_goal(Fibonacci.Goal())
    await graph.settle()
    goal_id = {"uuid": [7] * 16}
    _, answer = await asyncio.gather(
        operator.sending.call(SendGoal.Request(goal_id=goal_id, goal=Fibonacci.Goal())),
        operator.cancelling.call(CancelGoal.Request(goal_info={"goal_id": goal_id})),
    )
    await graph.settle()

    assert (answer.return_code, len(answer.goals_canceling)) == (0, 1)
    assert [goal.status for goal in cleaner.at_work.goals.values()] == [EXECUTING, CANCELED]
    assert older.status is EXECUTING
    assert cleaner.cancels == 0


def test_a_server_that_is_replaced() -> None:
    """Its goals are lost, and not aborted: who has come in its place knows nothing of them."""

    async def story(world: World) -> None:
        await world.start(old := Cleaner(0.0), asker := Asker())
        goal = await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await world.kill(old)
        await world.start(Cleaner(0.0))
        with pytest.raises(GoalLost, match="does not know the goal: its server was replaced"):
            await goal.result(timeout=2.0)
        assert goal.status is LOST

    simulate(story, delay=(0.0, 0.02))


async def begun(world: World, cleaner: Cleaner) -> tuple[Asker, ClientGoalHandle[Any, Any, Any]]:
    await world.start(cleaner, asker := Asker())
    goal = await asker.do.send_goal(Fibonacci.Goal())
    await asyncio.sleep(0.1)
    return asker, goal


async def decide(_: Fibonacci.Goal) -> bool:
    await asyncio.sleep(0.5)
    return True


def background_errors(story: Callable[[World], Coroutine[Any, Any, None]], **options: Any) -> list[str]:
    """What the loop's exception handler was told in a story."""
    errors: list[str] = []

    async def watched(world: World) -> None:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: errors.append(f"{context['message']}: {context['exception']!r}"))
        await story(world)

    simulate(watched, **options)
    return errors


def test_cancelling_what_was_preempted() -> None:
    """A body that cleans up for a newer goal is not disturbed when a client cancels its goal too."""

    async def story(world: World) -> None:
        asker, goal = await begun(world, cleaner := Cleaner(policy="preempt"))
        await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await goal.cancel()
        await asyncio.sleep(2.0)
        assert (cleaner.cancels, cleaner.cleaned) == (1, 1)

    simulate(story)


def test_stopping_while_a_body_cleans_up() -> None:
    """A node that stops leaves bodies alone that were cancelled before; they have their time."""

    async def story(world: World) -> None:
        _, goal = await begun(world, cleaner := Cleaner())
        await goal.cancel()
        await core_of(cleaner).stop()
        assert (cleaner.cancels, cleaner.cleaned) == (1, 1)

    simulate(story)


async def test_many_goals_at_once_for_a_queue(graph: Graph) -> None:
    """No more of them wait than may."""
    await graph.start(Cleaner(0.0, policy="queue"), asker := Asker())
    await asker.do.send_goal(Fibonacci.Goal())
    await graph.settle()
    goals = [asker.do.send_goal(Fibonacci.Goal()) for _ in range(40)]
    outcomes = await asyncio.gather(*goals, return_exceptions=True)

    assert sum(isinstance(outcome, GoalRejected) for outcome in outcomes) == 40 - RULES.queue_depth


def test_a_goal_sent_twice_while_the_server_decides() -> None:
    """Both requests get the same answer."""

    async def story(world: World) -> None:
        await world.start(Cleaner(accept=decide), operator := Operator(lambda _: None))
        request = SendGoal.Request(goal_id={"uuid": [7] * 16}, goal=Fibonacci.Goal())
        asked = [operator.sending.call(request) for _ in range(2)]
        answers = await asyncio.gather(*asked, return_exceptions=True)
        assert [getattr(answer, "accepted", answer) for answer in answers] == [True, True]

    simulate(story)


def test_a_client_that_dies_before_its_goal_is_accepted() -> None:
    """Its goal is cancelled too, where the server cancels those of clients that have gone."""

    async def story(world: World) -> None:
        await world.start(cleaner := Cleaner(accept=decide, on_client_loss="cancel"), asker := Asker())
        sending = asyncio.create_task(asker.do.send_goal(Fibonacci.Goal()))
        await asyncio.sleep(0.1)
        await world.kill(asker)
        await asyncio.gather(sending, return_exceptions=True)
        await asyncio.sleep(20.0)
        assert cleaner.at_work.book.active() == 0

    simulate(story)


async def test_a_thread_that_looks_late(graph: Graph) -> None:
    """A body in a thread is told that it is to end also when it looks after its time to clean up."""
    may_look, has_looked, told = threading.Event(), asyncio.Event(), list[bool]()

    class Blocking(Node):
        @action(Fibonacci, "do", thread=True, cleanup_timeout=2.0)
        def body(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            may_look.wait(20.0)
            told.append(goal.is_cancel_requested)
            self.context.loop.call_soon_threadsafe(has_looked.set)
            return Fibonacci.Result()

    graph.waits_outside = False
    await graph.start(Blocking(), asker := Asker())
    goal = await asker.do.send_goal(Fibonacci.Goal())
    await graph.settle()
    assert await goal.cancel()
    await graph.clock.advance(2.0)
    may_look.set()
    await has_looked.wait()

    assert told == [True]


def test_a_body_that_ends_when_its_goal_is_forgotten() -> None:
    """Nothing comes of it."""

    async def story(world: World) -> None:
        await world.start(Cleaner(1000.0, policy="parallel"), asker := Asker())
        goal = await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await goal.cancel()
        await asyncio.sleep(950.0)
        await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(100.0)

    assert background_errors(story) == []


@slow
def test_a_body_that_outlives_its_server() -> None:
    """A body that goes on when its node has stopped ends without an error in the background."""

    async def story(world: World) -> None:
        await world.start(cleaner := Cleaner(5.0), asker := Asker())
        await asker.do.send_goal(Fibonacci.Goal())
        await asyncio.sleep(0.1)
        await core_of(cleaner).stop()
        await asyncio.sleep(10.0)

    assert background_errors(story) == []


def test_a_request_that_arrives_when_its_server_has_stopped() -> None:
    """Its caller is told soon."""

    async def story(world: World) -> None:
        await world.start(cleaner := Cleaner(), asker := Asker())
        sending = asyncio.create_task(asker.do.send_goal(Fibonacci.Goal(), timeout=100.0))
        await asyncio.sleep(0.01)
        await core_of(cleaner).stop()
        await asyncio.gather(sending, return_exceptions=True)
        assert now() < 2.0

    assert background_errors(story, delay=(0.05, 0.05)) == []


def test_a_client_that_is_closed_while_a_block_is_left() -> None:
    """The block is left; whoever leaves it is not cancelled by that."""

    async def story(world: World) -> None:
        await world.start(Cleaner(), asker := Asker())

        async def ask() -> None:
            async with asker.do.send(Fibonacci.Goal()):
                pass

        asking = asyncio.create_task(ask())
        await asyncio.sleep(0.1)
        await core_of(asker).stop()
        await asyncio.wait([asking])
        assert not asking.cancelled()

    simulate(story)


@slow
def test_a_sender_that_is_cancelled_when_its_node_has_stopped() -> None:
    """It gets its CancelledError."""

    async def story(world: World) -> bool:
        await world.start(Cleaner(accept=decide), asker := Asker())
        sending = asyncio.create_task(asker.do.send_goal(Fibonacci.Goal()))
        await asyncio.sleep(0.1)
        await core_of(asker).stop()
        sending.cancel()
        await asyncio.gather(sending, return_exceptions=True)
        return sending.cancelled()

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # what it would do in the background is never awaited
        was_cancelled = simulate(story)
        gc.collect()
    assert was_cancelled


def test_a_node_that_was_killed_is_silent() -> None:
    """What a simulated node does in its stopping, after its death, reaches nobody."""

    class Dying(Node):
        said = Publisher(Int32, "said")

        async def on_shutdown(self) -> None:
            self.said.publish(Int32(data=1))

    class Hearer(Node):
        heard = Subscription(Int32, "said")

    async def story(world: World) -> None:
        await world.start(dying := Dying(), hearer := Hearer())
        await asyncio.sleep(1.0)
        await world.kill(dying)
        await asyncio.sleep(1.0)
        assert hearer.heard.received == 0

    simulate(story)
