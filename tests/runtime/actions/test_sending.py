"""Blocks of goals."""

from __future__ import annotations

import pytest

from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.testing import Graph
from tests.runtime.cast import pair

Caplog = pytest.LogCaptureFixture


def _told(caplog: Caplog) -> list[str]:
    return [text for text in caplog.messages if "the block ends at once" in text]


async def test_a_block_that_ends_at_once(graph: Graph, caplog: Caplog) -> None:
    """Is told at the client, once for its line."""
    _, asker = await pair(graph)
    for _ in range(3):
        async with asker.fibonacci.send(Fibonacci.Goal(order=50)) as goal:
            order = goal.request.order
    assert order == 50
    (text,) = _told(caplog)
    assert "test_sending.py:22: the block ends at once" in text


async def test_blocks_that_end_otherwise(graph: Graph, caplog: Caplog) -> None:
    """Are not told: by an error, detached, cancelled by hand, or after a wait."""
    _, asker = await pair(graph)
    with pytest.raises(ZeroDivisionError):
        async with asker.fibonacci.send(Fibonacci.Goal(order=50)) as goal:
            goal.request.order //= 0
    async with asker.fibonacci.send(Fibonacci.Goal(order=0), detach=True) as goal:
        assert not goal.done
    await graph.clock.advance(5.0)
    async with asker.fibonacci.send(Fibonacci.Goal(order=50)) as goal:
        await goal.cancel()
    await graph.clock.advance(5.0)
    async with asker.fibonacci.send(Fibonacci.Goal(order=50)) as goal:
        await graph.clock.advance(0.1)
    assert _told(caplog) == []
