"""Goals at their client: followed, left, and lost."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import (
    Abort,
    ActionClient,
    GoalAborted,
    GoalCanceled,
    GoalLost,
    GoalStatus,
    Node,
    ServiceUnavailable,
    action,
    task,
)
from graphflow.errors import EncodeError, GoalRejected
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.runtime.actions import client
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.runtime.actions.goal_reasons import Reasons
from graphflow.runtime.actions.server import ActionServer
from graphflow.runtime.endpoints.serialized import UNKNOWN
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.wire.goal_status import GoalStates
from tests.runtime.cast import Asker, Log, Server, pair


async def test_leaving_the_block_cancels(graph: Graph) -> None:
    """The body gets CancelledError once, and the client the partial result."""
    server, asker = await pair(graph)
    ended = Log()

    async def give_up() -> None:
        async with asker.fibonacci.send(Fibonacci.Goal(order=50)) as goal:
            async for _ in goal.feedback():
                break
        ended(goal.status)
        with pytest.raises(GoalCanceled) as caught:
            await goal.result()
        ended(list(caught.value.result.sequence))  # type: ignore[attr-defined]

    giving_up = asyncio.ensure_future(give_up())
    await graph.clock.advance(1.0)
    await giving_up

    assert ended == [GoalStatus.CANCELED, [0, 1, 1]]
    assert server.told == ["cancel requested"]
    assert server.bodies == 0


async def test_a_client_that_is_cancelled_cancels_its_goal_first(graph: Graph) -> None:
    """Then the cancellation goes on its way."""
    server, asker = await pair(graph)

    async def follow() -> None:
        async with asker.fibonacci.send(Fibonacci.Goal(order=50)) as goal:
            await goal.result()

    following = asyncio.ensure_future(follow())
    await graph.clock.advance(1.0)
    following.cancel()
    with pytest.raises(asyncio.CancelledError):
        await following

    assert server.told == ["cancel requested"]


async def test_a_detached_goal_goes_on(graph: Graph) -> None:
    """With `detach=True`, leaving the block does not cancel the goal."""
    server, asker = await pair(graph)
    async with asker.fibonacci.send(Fibonacci.Goal(order=4), detach=True) as goal:
        assert goal.status is GoalStatus.ACCEPTED
    await graph.clock.advance(2.0)

    assert list((await goal.result()).sequence) == [0, 1, 1, 2]
    assert server.told == []


async def test_a_server_that_dies_loses_its_goals(graph: Graph) -> None:
    """Their status is LOST, and waits for them end."""
    server, asker = await pair(graph)
    goal = await asker.order(50)
    await graph.settle()
    for endpoint in core_of(server).parts[-1].endpoints:
        endpoint.close()
    await graph.clock.advance(1.0)

    assert goal.status is GoalStatus.LOST
    with pytest.raises(GoalLost, match="the server has gone, and with it the goal, last known as EXECUTING"):
        await goal.result()


async def test_no_server_and_another_type(graph: Graph) -> None:
    """The error names the missing action and the nearest name on offer."""
    asker = Asker()
    other = Node("other")
    other.create_action_server(Fibonacci, "fibonaci", print)
    await graph.start(other, asker)
    sending = asyncio.ensure_future(asker.order(1))
    await graph.clock.advance(1.0)

    with pytest.raises(ServiceUnavailable, match=r"no node offers the action /fibonacci .*did you mean '/fibonaci'"):
        await sending
    assert not asker.fibonacci._goals
    assert not asker.fibonacci._running
    with pytest.raises(EncodeError, match=r"takes .*Fibonacci_Goal, not"):
        await asker.fibonacci.send_goal(Fibonacci.Result())  # type: ignore[arg-type]


async def test_a_node_may_send_a_goal_to_itself(graph: Graph) -> None:
    """From a task, with the goal's body in whatever group."""

    class Both(Server):
        mine = ActionClient(Fibonacci, "fibonacci")

        @task
        async def ask(self) -> None:
            async with self.mine.send(Fibonacci.Goal(order=3)) as goal:
                self.told(list((await goal.result()).sequence))

    both = Both()
    await graph.start(both)
    await graph.clock.advance(1.0)

    assert both.told == [[0, 1, 1]]


async def test_a_result_that_is_not_to_be_had(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """The server is there, and the client gets its error."""

    def broken(*_: Any) -> None:
        raise LookupError("mislaid")

    monkeypatch.setattr(ActionServer, "_get_result", broken)
    _, asker = await pair(graph)
    goal = await asker.order(3)
    await graph.clock.advance(1.0)

    with pytest.raises(GoalLost, match="result is not available, last known as EXECUTING"):
        await goal.result()


async def test_a_result_that_was_lost_is_asked_for_again(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once, soon after the server has reported the end; a result that arrives by itself is not requested."""
    asked, get_result = Log(), ActionServer._get_result

    async def lost(server: Any, request: Any, client: bytes) -> Any:
        asked(request)
        if len(asked) == 2:
            await asyncio.Event().wait()
        return await get_result(server, request, client)

    monkeypatch.setattr(ActionServer, "_get_result", lost)
    _, asker = await pair(graph)
    goal = await asker.order(3)
    await graph.clock.advance(3.0)
    assert (goal.done, len(asked)) == (True, 1)

    goal = await asker.order(3)
    await graph.clock.advance(1.0)
    for _ in range(2):
        asker.fibonacci._status_received(status(goal, GoalStatus.SUCCEEDED), UNKNOWN)
    assert (goal.done, len(asker.fibonacci._followers)) == (False, 2)
    await graph.clock.advance(client.LOST_GRACE)
    assert (goal.done, len(asked)) == (True, 3)


def status(goal: ClientGoalHandle[Any, Any, Any], state: int) -> bytes:
    """Return a status message as a server sends it."""
    states = GoalStates()
    states.add(goal.goal_id, 0)
    states.put(goal.goal_id, state)
    return states.to_bytes()


async def test_states_that_say_nothing(graph: Graph) -> None:
    """Those that ROS does not have, those of a goal that is over, and malformed ones, which are counted."""
    server, asker = await pair(graph)
    client, goal = asker.fibonacci, await asker.order(50)
    await graph.settle()
    for state in (7, 255, GoalStatus.ACCEPTED):
        client._status_received(status(goal, state), UNKNOWN)
        assert goal.status is GoalStatus.EXECUTING
    client._status_received(b"", UNKNOWN)
    assert client._status.malformed == 1
    for endpoint in core_of(server).parts[-1].endpoints:
        endpoint.close()
    await graph.clock.advance(1.0)
    client._status_received(status(goal, GoalStatus.EXECUTING), UNKNOWN)
    assert goal.status is GoalStatus.LOST


REASONS = [
    (Abort("the way is blocked"), "the way is blocked"),
    (KeyError("lost"), "KeyError: 'lost'"),
    (Abort("\x1b[2Jcleared\x9b31m\a"), "\\x1b[2Jcleared\\x9b31m\\x07"),
    (OSError("\x1b[2J"), "OSError: \\x1b[2J"),
    (Abort("x" * 100_000), "x" * 1000),
    (Abort("ä" * 100_000), "ä" * 1000),
]


class Giving(Node):
    """Gives every goal up."""

    def __init__(self, error: Exception) -> None:
        super().__init__()
        self.error = error

    @action(Fibonacci, "fibonacci")
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        goal.partial = Fibonacci.Result(sequence=[4])
        raise self.error


async def aborted(graph: Graph, error: Exception, caplog: pytest.LogCaptureFixture) -> tuple[GoalAborted, list[str]]:
    """Return the error of an aborted goal, and the log of its client."""
    _, asker = await pair(graph, Giving(error))
    goal = await asker.order(1)
    with pytest.raises(GoalAborted) as caught:
        await goal.result()
    return caught.value, [r.getMessage() for r in caplog.records if r.name == "graphflow.node.asker"]


@pytest.mark.parametrize(("error", "reason"), REASONS, ids=[reason[:20] for _, reason in REASONS])
async def test_the_client_learns_why(
    graph: Graph, caplog: pytest.LogCaptureFixture, error: Exception, reason: str
) -> None:
    """The reason is requested after the abort; it has a limited length and no control characters."""
    caught, said = await aborted(graph, error, caplog)

    assert str(caught) == f"/fibonacci aborted the goal: {reason}"
    assert list(caught.result.sequence) == [4]  # type: ignore[attr-defined]
    assert said == []


async def test_an_abort_without_a_reason(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """No warning is logged."""
    caught, said = await aborted(graph, Abort(), caplog)

    assert (str(caught), said) == ("/fibonacci aborted the goal", [])


async def test_ros_2_knows_no_reasons(
    graph: Graph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """There is no query to another kind of server."""
    monkeypatch.setattr(Reasons, "note", lambda *_: None)
    caught, said = await aborted(graph, Abort("the way is blocked"), caplog)

    assert (str(caught), said) == ("/fibonacci aborted the goal", [])


async def test_a_closed_client_loses_its_goals(graph: Graph) -> None:
    """Waits for them end with GoalLost."""
    _, asker = await pair(graph)
    goal = await asker.order(50)
    waiting = asyncio.create_task(goal.result())
    await graph.settle()
    asker.fibonacci.close()

    with pytest.raises(GoalLost, match="the client of /fibonacci was closed before the goal ended"):
        await waiting
    assert goal.status is GoalStatus.LOST


async def test_a_goal_that_nobody_offers_can_be_given_up(graph: Graph) -> None:
    """At once: there is no server to wait for."""
    asker = Asker()
    await graph.start(asker)
    sending = asyncio.ensure_future(asker.fibonacci.send_goal(Fibonacci.Goal(order=1)))
    await graph.settle()
    sending.cancel()
    await graph.settle()
    assert sending.cancelled()


async def test_what_decides_on_goals_without_being_a_method(graph: Graph) -> None:
    """A lambda, or a function from elsewhere, is called as one."""

    def odd(self: Node, goal: Any) -> bool:
        return bool(goal.order % 2)

    class Picks(Node):
        @action(Fibonacci, "small", accept=lambda self, goal: goal.order < 3)
        async def small(self, goal: Any) -> Fibonacci.Result:
            return Fibonacci.Result()

        @action(Fibonacci, "odd", accept=odd)
        async def counted(self, goal: Any) -> Fibonacci.Result:
            return Fibonacci.Result()

    await graph.start(Picks())
    await graph.settle()
    for name in ("/small", "/odd"):
        client = graph.action_client(Fibonacci, name)
        await client.send_goal(Fibonacci.Goal(order=1))
        with pytest.raises(GoalRejected):
            await client.send_goal(Fibonacci.Goal(order=4))


async def test_goals_that_are_rejected_are_not_remembered(graph: Graph) -> None:
    """Not even if the server never sends a status message."""

    class Refuses(Node):
        def never(self, goal: Any) -> str:
            return "not today"

        @action(Fibonacci, "fibonacci", accept=never)
        async def fibonacci(self, goal: Any) -> Fibonacci.Result:
            raise AssertionError

    await graph.start(Refuses())
    client = graph.action_client(Fibonacci, "/fibonacci")
    await graph.settle()
    for _ in range(3):
        with pytest.raises(GoalRejected, match="not today"):
            await client.send_goal(Fibonacci.Goal())
    assert (client._goals, client._running) == ({}, set())
