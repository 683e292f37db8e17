"""Actions: goals accepted, run, cancelled, pre-empted and remembered."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import Abort, GoalAborted, GoalRejected, GoalStatus, Group, Node, action
from graphflow.interface import GoalPolicy
from graphflow.machines.goal import GoalEvent
from graphflow.msgs.action_msgs.msg import GoalStatusArray
from graphflow.msgs.action_msgs.srv import CancelGoal
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.registry import interface_class
from graphflow.runtime.actions.server import ActionServer
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.testing.graph import TRANSIENT_LOCAL
from tests.cases import count, slow
from tests.runtime.cast import Log, pair

PREEMPTIONS = count(few=250, full=1000)


def at_work(server: Node) -> ActionServer[Any, Any, Any]:
    [found] = [part for part in core_of(server).parts if isinstance(part, ActionServer)]
    return found


async def test_a_goal_succeeds(graph: Graph) -> None:
    """The client gets every feedback, then the result; states follow ROS 2's machine."""
    _, asker = await pair(graph)
    states = graph.tap(GoalStatusArray, "/fibonacci/_action/status", TRANSIENT_LOCAL)
    heard, result = Log(), Log()

    async def follow() -> None:
        async with asker.fibonacci.send(Fibonacci.Goal(order=5)) as goal:
            async for feedback in goal.feedback():
                heard(list(feedback.sequence))
            result(list((await goal.result()).sequence))
            assert goal.status is GoalStatus.SUCCEEDED

    following = asyncio.ensure_future(follow())
    await graph.clock.advance(3.0)
    await following

    assert heard == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]]
    assert result == [[0, 1, 1, 2, 3]]
    assert [[s.status for s in m.status_list] for m in states if m.status_list] == [[1], [2], [4]]


@pytest.mark.parametrize("order", [100, 13])
async def test_a_goal_can_be_refused(graph: Graph, order: int) -> None:
    """By the accept hook, also by one that fails."""
    _, asker = await pair(graph)

    with pytest.raises(GoalRejected, match="/fibonacci rejected the goal"):
        await asker.order(order)


async def test_a_cancel_request_can_be_refused(graph: Graph) -> None:
    """The goal keeps running, and the response's code gives the reason."""
    _, asker = await pair(graph)
    goal = await asker.order(7)
    await graph.settle()

    assert not await goal.cancel()
    answer = await graph.call(CancelGoal, "/fibonacci/_action/cancel_goal", CancelGoal.Request())
    assert (answer.return_code, len(answer.goals_canceling)) == (1, 0)
    assert goal.status is GoalStatus.EXECUTING


@pytest.mark.parametrize(
    ("ending", "status", "numbers"),
    [
        ("abort", "ABORTED", [1]),
        ("abort with result", "ABORTED", [2]),
        ("error", "ABORTED", [1]),
        ("wrong type", "ABORTED", [1]),
        ("swallows", "SUCCEEDED", [3]),
    ],
)
async def test_how_a_body_can_end(graph: Graph, ending: str, status: str, numbers: list[int]) -> None:
    """Abort gives its result or the partial one, an error the partial one; a body may succeed although cancelled."""

    class Ends(Node):
        @action(Fibonacci, "fibonacci")
        async def compute(self, goal: Fibonacci.Handle) -> Any:
            goal.partial = Fibonacci.Result(sequence=[1])
            if ending == "abort":
                raise Abort("no way")
            if ending == "abort with result":
                raise Abort(Fibonacci.Result(sequence=[2]))
            if ending == "error":
                raise KeyError("lost")
            if ending == "wrong type":
                return Fibonacci.Feedback()
            try:
                await asyncio.Event().wait()
            except asyncio.CancelledError:
                return Fibonacci.Result(sequence=[3])

    _, asker = await pair(graph, Ends())
    goal = await asker.order(1)
    await graph.settle()
    if ending == "swallows":
        assert await goal.cancel()
        await graph.settle()

    assert goal.status.name == status
    if status == "ABORTED":
        with pytest.raises(GoalAborted) as caught:
            await goal.result()
        assert list(caught.value.result.sequence) == numbers  # type: ignore[attr-defined]
    else:
        assert list((await goal.result()).sequence) == numbers


class Recorder(Node):
    """Record the runs of its handler; each ends on request, and takes time to clean up."""

    def __init__(self, policy: GoalPolicy, **options: Any) -> None:
        super().__init__("recorder")
        self.log_of = Log()
        self.gate = asyncio.Event()
        self.most = self.now = 0
        self.create_action_server(Fibonacci, "fibonacci", self.compute, policy=policy, **options)

    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        n = goal.request.order
        self.now += 1
        self.most = max(self.most, self.now)
        self.log_of(f"{n} begins")
        try:
            await self.gate.wait()
        finally:
            if self.gate.is_set() or goal.is_cancel_requested:
                await self.clock.sleep(0.5)
            self.now -= 1
            self.log_of(f"{n} ends")
        return Fibonacci.Result(sequence=[n])


async def send_three(graph: Graph, policy: GoalPolicy, **options: Any) -> tuple[Recorder, list[Any]]:
    server, asker = await pair(graph, Recorder(policy, **options))
    outcomes: list[Any] = []
    for n in (1, 2, 3):
        try:
            outcomes.append(await asker.order(n))
        except GoalRejected:
            outcomes.append("rejected")
        await graph.settle()
    server.gate.set()
    await graph.clock.advance(5.0)
    return server, [o if o == "rejected" else o.status.name for o in outcomes]


@pytest.mark.parametrize(
    ("policy", "outcomes", "log", "most"),
    [
        ("reject", ["SUCCEEDED", "rejected", "rejected"], ["1 begins", "1 ends"], 1),
        ("queue", ["SUCCEEDED"] * 3, [f"{n} {w}" for n in (1, 2, 3) for w in ("begins", "ends")], 1),
        ("preempt", ["ABORTED", "ABORTED", "SUCCEEDED"], ["1 begins", "1 ends", "3 begins", "3 ends"], 1),
        ("parallel", ["SUCCEEDED"] * 3, [f"{n} {w}" for w in ("begins", "ends") for n in (1, 2, 3)], 3),
    ],
)
@pytest.mark.parametrize("group", [None, Group(None)])
async def test_policies(
    graph: Graph, policy: GoalPolicy, outcomes: list[str], log: list[str], most: int, group: Group | None
) -> None:
    """One goal at a time, whatever the group allows, but for `parallel`; pre-empted goals clean up before the next."""
    server, got = await send_three(graph, policy, group=group)

    assert got == outcomes
    assert server.log_of == log
    assert server.most == most


@slow
async def test_many_preemptions_never_run_two_bodies(graph: Graph) -> None:
    """However quickly new goals come."""
    server, asker = await pair(graph, Recorder("preempt", group=Group(None)))
    goals = []
    for n in range(PREEMPTIONS):
        goals.append(await asker.order(n))
        if n % 7 == 0:
            await graph.settle()
        if n % 31 == 0:
            await graph.clock.advance(0.5)
    server.gate.set()
    await graph.clock.advance(5.0)

    assert server.most == 1
    assert server.now == 0
    assert {goal.status.name for goal in goals[:-1]} == {"ABORTED"}
    assert goals[-1].status is GoalStatus.SUCCEEDED


async def test_a_goal_that_waits_is_cancelled_without_running(graph: Graph) -> None:
    """It is CANCELED at once, and its body never sees it."""
    server, asker = await pair(graph, Recorder("queue"))
    await asker.order(1)
    waiting = await asker.order(2)
    await graph.settle()

    assert await waiting.cancel()
    await graph.settle()

    assert waiting.status is GoalStatus.CANCELED
    assert server.log_of == ["1 begins"]


async def test_a_goal_cancelled_before_its_body_was_reached(graph: Graph) -> None:
    """Between its acceptance and its first step."""
    server, asker = await pair(graph, Recorder("queue"))
    sending = asyncio.ensure_future(asker.order(1))
    while not at_work(server).goals:
        await asyncio.sleep(0)
    [handle] = at_work(server).goals.values()
    at_work(server)._step(handle, GoalEvent.CANCEL)
    goal = await sending
    await graph.settle()

    assert goal.status is GoalStatus.CANCELED
    assert server.log_of == []


async def test_a_body_that_outstays_its_cancellation(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Its goal is aborted when the clean-up takes too long; the slot stays taken until the body has really ended."""

    class Stubborn(Node):
        work = Group(1)
        gate = asyncio.Event()

        @action(Fibonacci, "fibonacci", group=work, cleanup_timeout=2.0)
        async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            try:
                await asyncio.Event().wait()
            finally:
                await self.gate.wait()
            raise AssertionError

    server, asker = await pair(graph, Stubborn())
    goal = await asker.order(1)
    await graph.settle()
    assert await goal.cancel()
    await graph.clock.advance(1.9)
    assert not goal.done
    await graph.clock.advance(0.1)

    assert goal.status is GoalStatus.ABORTED
    assert server.work.running == 1
    assert "compute is still running 2 s after it was cancelled" in caplog.text
    server.gate.set()
    await graph.settle()
    assert server.work.running == 0


async def test_a_goal_sent_twice_runs_once(graph: Graph) -> None:
    """A client without a response may send the same id again, before and after the end."""
    server, _ = await pair(graph)
    send: Any = interface_class("example_interfaces/action/Fibonacci_SendGoal")
    request = send.Request(goal_id={"uuid": [7] * 16}, goal=Fibonacci.Goal(order=3))
    answers = [await graph.call(send, "/fibonacci/_action/send_goal", request)]
    await graph.clock.advance(1.0)
    answers.append(await graph.call(send, "/fibonacci/_action/send_goal", request))

    assert [a.accepted for a in answers] == [True, True]
    assert answers[0].stamp == answers[1].stamp
    assert server.statistics()["action /fibonacci"]["runs"] == 1


async def test_a_result_can_be_asked_for_later_and_by_others(graph: Graph) -> None:
    """For a quarter of an hour from the goal's end on; then, as for any unknown goal, the state is UNKNOWN."""
    _, asker = await pair(graph)
    goal = await asker.order(4)
    get: Any = interface_class("example_interfaces/action/Fibonacci_GetResult")
    request = get.Request(goal_id={"uuid": list(goal.goal_id)})
    asked = [asyncio.ensure_future(graph.call(get, "/fibonacci/_action/get_result", request)) for _ in range(3)]
    await graph.clock.advance(2.0)
    assert [list((await a).result.sequence) for a in asked] == [[0, 1, 1, 2]] * 3
    await graph.clock.advance(899.0)
    assert (await graph.call(get, "/fibonacci/_action/get_result", request)).status == 4
    await graph.clock.advance(2.0)
    await asker.order(2)  # the book is cleared when something is written into it

    answer = await graph.call(get, "/fibonacci/_action/get_result", request)
    assert (answer.status, len(answer.result.sequence)) == (0, 0)


async def test_a_server_that_stops_aborts_its_goals(graph: Graph) -> None:
    """Their clients get the partial results, also of those that waited for their turn."""
    server, asker = await pair(graph, Recorder("queue"))
    goals = [await asker.order(n) for n in (1, 2)]
    await graph.settle()
    await graph.stop(server)
    await graph.settle()

    assert [goal.status.name for goal in goals] == ["ABORTED", "ABORTED"]


@pytest.mark.parametrize(("on_client_loss", "status"), [("continue", 2), ("cancel", 5)])
async def test_a_client_that_dies(graph: Graph, on_client_loss: str, status: int) -> None:
    """Its goal goes on or is cancelled, after a while in which it could have come back."""
    server, asker = await pair(graph, Recorder("reject", on_client_loss=on_client_loss))
    goal = await asker.order(1)
    await graph.settle()
    await graph.stop(asker)
    await graph.clock.advance(4.9)
    [handle] = at_work(server).goals.values()
    assert handle.status is GoalStatus.EXECUTING
    await graph.clock.advance(1.0)

    assert handle.goal_id == goal.goal_id
    assert handle.status == status


class Crowd(Node):
    """Has as many goals under way as are sent, in no group."""

    bodies = 0

    @action(Fibonacci, "fibonacci", policy="parallel")
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        self.bodies += 1
        await self.clock.sleep(10.0)
        self.bodies -= 1
        return Fibonacci.Result()


async def test_a_parallel_action_that_is_moved(graph: Graph) -> None:
    """It takes turns in the group that it is moved to, and none when it is moved back to no group."""
    server, asker = await pair(graph, Crowd())
    [runner] = [r for r in core_of(server).runners if r.spec.handler == "compute"]
    for order in (1, 2):
        await asker.order(order)
    await graph.settle()
    assert server.bodies == 2

    runner.move(core_of(server).groups.named("one"))
    for order in (3, 4):
        await asker.order(order)
    await graph.settle()
    assert server.bodies == 3
    runner.move(core_of(server).groups.named("none"))
    await graph.settle()
    assert server.bodies == 4


class Careless(Node):
    """Its results cannot be sent."""

    @action(Fibonacci, "fibonacci")
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        wrong = Fibonacci.Result()
        wrong.sequence = [2**40]  # type: ignore[assignment]
        if goal.request.order:
            goal.partial = wrong
            raise Abort("it got too large")
        return wrong


@pytest.mark.parametrize("order", [0, 1])
async def test_a_result_that_cannot_be_sent(graph: Graph, caplog: pytest.LogCaptureFixture, order: int) -> None:
    """The goal is aborted, and the server logs the reason."""
    _, asker = await pair(graph, Careless())
    goal = await asker.order(order)
    await graph.clock.advance(0.1)

    with pytest.raises(GoalAborted):
        await goal.result()
    assert "sequence" in caplog.text
    assert str(2**40) in caplog.text


async def test_feedback_of_another_type(graph: Graph) -> None:
    """The goal is aborted with how feedback is made."""

    class Server(Node):
        @action(Fibonacci, "count")
        async def count(self, goal: Any) -> Fibonacci.Result:
            goal.feedback([0, 1])
            return Fibonacci.Result()

    asker = Node("asker")
    client = asker.create_action_client(Fibonacci, "count")
    await graph.start(Server(), asker)
    async with client.send(Fibonacci.Goal(order=1)) as goal:
        with pytest.raises(GoalAborted, match=r"sends feedback as Fibonacci.Feedback\(sequence=...\), not \[0, 1\]"):
            await goal.result()
