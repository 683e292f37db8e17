"""The handles of goals at clients and servers."""

from __future__ import annotations

import asyncio
import threading
from types import SimpleNamespace
from typing import Any, cast

import pytest

from graphflow import GoalCanceled, Node, action
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.runtime.actions import goal_handles
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.testing import Graph
from tests.runtime.cast import pair


async def test_feedback_that_nobody_reads_is_bounded(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """The newest wait for the first reader, the others are counted; `latest` is always the last."""
    monkeypatch.setattr(goal_handles, "FEEDBACK_KEPT", 2)
    _, asker = await pair(graph)
    goal = await asker.order(6)
    await graph.clock.advance(4.0)

    assert [len(feedback.sequence) async for feedback in goal.feedback()] == [5, 6]
    assert goal.dropped == 2
    assert goal.latest is not None
    assert len(goal.latest.sequence) == 6


async def test_a_result_may_be_awaited_for_a_while(graph: Graph) -> None:
    """The goal goes on when the time is up."""
    _, asker = await pair(graph)
    goal = await asker.order(4)
    waiting = asyncio.create_task(goal.result(timeout=1.5))
    await graph.clock.advance(1.5)
    with pytest.raises(TimeoutError):
        await waiting
    assert not goal.done
    await graph.clock.advance(0.5)

    assert list((await goal.result(timeout=1.0)).sequence) == [0, 1, 1, 2]


async def test_a_field_of_its_result_or_feedback(graph: Graph) -> None:
    """The hint names the goal's result and feedback."""
    _, asker = await pair(graph)
    sent = goal = cast("Any", await asker.order(4))
    with pytest.raises(AttributeError) as caught:
        _ = sent.sequence
    explain(caught.value)
    assert str(caught.value).endswith("; that is the goal; its result has it: (await sent.result()).sequence")
    fields = [type("Of", (), {"__struct_fields__": names}) for names in (("distance",), ("elapsed",))]
    goal._client = SimpleNamespace(type=SimpleNamespace(Result=fields[0], Feedback=fields[1]))
    assert goal._hint("elapsed").endswith("async for feedback in IT.feedback():")
    assert goal._hint("other") == ""


async def test_a_blocking_body_in_a_thread_polls_for_its_cancellation(graph: Graph) -> None:
    """A thread cannot be interrupted; it looks, and its goal is canceled when it raises CancelledError."""
    begun = asyncio.Event()

    class Blocking(Node):
        @action(Fibonacci, "fibonacci", thread=True)
        def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            self.context.loop.call_soon_threadsafe(begun.set)
            while not goal.is_cancel_requested:
                threading.Event().wait(0.001)
            raise asyncio.CancelledError

    _, asker = await pair(graph, Blocking())
    goal = await asker.order(1)
    await begun.wait()
    assert await goal.cancel()
    with pytest.raises(GoalCanceled):
        await goal.result()


async def test_a_field_of_its_request(graph: Graph) -> None:
    """The hint names the request; the goal's text, the action and the status."""
    caught: list[AttributeError] = []

    class Server(Node):
        @action(Fibonacci, "fibonacci")
        async def compute(self, goal: Any) -> Fibonacci.Result:
            assert repr(goal).endswith(" of /fibonacci: EXECUTING>")
            for name in ("order", "colour"):
                try:
                    getattr(goal, name)
                except AttributeError as error:
                    caught.append(error)
            return Fibonacci.Result()

    _, asker = await pair(graph, Server())
    await (await asker.order(1)).result()
    for error in caught:
        explain(error)
    order, colour = map(str, caught)
    assert order.endswith("; the client's request has it: goal.request.order")
    assert "request" not in colour
