"""The Fibonacci action, with a client."""

from __future__ import annotations

import logging

import pytest

from graphflow import GoalRejected
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.testing import Graph
from nodes.fibonacci_client import FibonacciClient
from nodes.fibonacci_server import FibonacciServer


async def test_the_sequence_grows_by_one_a_second(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The client gets every step, then the result, and its node then ends."""
    caplog.set_level(logging.INFO)
    await graph.start(FibonacciServer(), client := FibonacciClient(order=4))
    await graph.clock.advance(3.0)

    assert caplog.messages == [
        "Executing goal...",
        "Received feedback: [0, 1, 1]",
        "Received feedback: [0, 1, 1, 2]",
        "Received feedback: [0, 1, 1, 2, 3]",
        "Result: [0, 1, 1, 2, 3]",
    ]
    await client.wait_ended()


async def test_impatience_cancels(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The goal ends where it was."""
    caplog.set_level(logging.INFO)
    await graph.start(FibonacciServer(), FibonacciClient(order=40, patience=2.5))
    await graph.clock.advance(3.0)

    assert caplog.messages[-2:] == ["This takes too long.", "No result: the goal of /fibonacci was cancelled"]


@pytest.mark.parametrize("order", [-1, 47])
async def test_what_cannot_be_counted_is_rejected(graph: Graph, order: int) -> None:
    """A sequence has numbers that an int32 holds."""
    await graph.start(FibonacciServer())
    client = graph.action_client(Fibonacci, "/fibonacci")
    await graph.settle()
    with pytest.raises(GoalRejected):
        await client.send_goal(Fibonacci.Goal(order=order))
