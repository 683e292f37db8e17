"""Reasons for rejected and aborted goals travel from the server's process to the client's."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import Abort, GoalRejected, Node, action
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.runtime.actions import goal_reasons
from graphflow.testing import Graph
from tests.cases import slow
from tests.runtime.cast import Server, pair

GOAL = bytes(range(16))


async def known_to(graph: Graph) -> tuple[Any, Any]:
    """The reasons of a server's process, and those of a client's."""
    server, asker = await pair(graph)
    return server.context.reasons, asker.context.reasons


async def test_a_reason_travels(graph: Graph) -> None:
    """To a client that queries by the goal's id; other ids have no reason."""
    server, client = await known_to(graph)
    server.note(GOAL, "the way is blocked")
    zid = server._session.zid
    assert await client.ask(zid, GOAL) == "the way is blocked"
    assert await client.ask(zid, bytes(16)) == ""
    assert await server.ask(zid, GOAL) == "the way is blocked"
    assert await client.ask("nobody", GOAL) == ""


async def test_reasons_are_bounded_and_cannot_be_obeyed(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """In number and length, on both sides."""
    server, client = await known_to(graph)
    zid = server._session.zid
    server.note(GOAL, "\x1b[2J" + "x" * 100_000)
    told = await client.ask(zid, GOAL)
    assert told.startswith("\\x1b[2Jxx")
    assert len(told) < goal_reasons.LONGEST + 10
    server._by_goal[GOAL] = "y" * 100_000  # a server that is not ours
    assert len(await client.ask(zid, GOAL)) == goal_reasons.LONGEST
    monkeypatch.setattr(goal_reasons, "KEPT", 2)
    for i in range(3):
        server.note(bytes([i]), str(i))
    assert list(server._by_goal.values()) == ["1", "2"]


class Choosy(Node):
    """Accept goals as the test decides."""

    def __init__(self, answer: Any) -> None:
        super().__init__()
        self.answer = answer

    def wants(self, goal: Fibonacci.Goal) -> Any:
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer

    @action(Fibonacci, "fibonacci", accept=wants)
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()


@pytest.mark.parametrize(
    ("answer", "reason"),
    [
        (False, "wants returned False"),
        (None, "wants returned None: it must return True, False, or the reason for the rejection"),
        ("outside of the field", "outside of the field"),
        (Abort("too far"), "too far"),
        (ValueError("no map"), "wants failed: ValueError: no map"),
    ],
)
async def test_why_a_goal_is_rejected(graph: Graph, caplog: pytest.LogCaptureFixture, answer: Any, reason: str) -> None:
    """The client's error and the server's log have the reason."""
    caplog.set_level("INFO")
    _, asker = await pair(graph, Choosy(answer))
    with pytest.raises(GoalRejected) as caught:
        await asker.order(3)
    assert str(caught.value) == f"/fibonacci rejected the goal: {reason}"
    assert any(r.getMessage().endswith(f" is rejected: {reason}") for r in caplog.records)


async def test_a_goal_that_is_wanted(graph: Graph) -> None:
    """`True` takes it, and so does an empty text."""
    server, asker = await pair(graph, Choosy(True))
    for answer in (True, "", 1):
        server.answer = answer
        assert (await (await asker.order(3)).result()) == Fibonacci.Result()


@slow
@pytest.mark.parametrize(
    ("policy", "goals", "reason"),
    [("reject", 2, "another goal is running, and policy='reject'"), ("queue", 18, "16 goals are waiting already")],
)
async def test_a_server_that_has_enough(graph: Graph, policy: Any, goals: int, reason: str) -> None:
    """The reason names the policy."""

    class Busy(Server):
        @action(Fibonacci, "fibonacci", policy=policy)
        async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            await self.clock.sleep(100.0)
            return Fibonacci.Result()

    _, asker = await pair(graph, Busy())
    for _ in range(goals - 1):
        await asker.order(50)
    await graph.settle()
    with pytest.raises(GoalRejected, match=reason):
        await asker.order(50)
