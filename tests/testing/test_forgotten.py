"""Calls that a test has not awaited."""

from __future__ import annotations

import asyncio
from pathlib import PurePath

from graphflow import Node
from graphflow.testing import Graph
from graphflow.testing.forgotten import forgotten


def told() -> list[str]:
    return [text.partition(": ")[2] for text in forgotten() if PurePath(__file__).name in text]


async def test_a_call_that_is_not_awaited(graph: Graph) -> None:
    """It is reported once, with the corrected line, or the call if the line has more than that."""
    graph.clock.advance(1.0)  # type: ignore[unused-coroutine]
    coroutine = graph.settle()
    assert told() == [
        "this has no effect until it is awaited; write await graph.clock.advance(1.0)",
        "this has no effect until it is awaited; write await graph.settle(...)",
    ]
    assert told() == []
    del coroutine


async def test_calls_that_begin(graph: Graph) -> None:
    """Awaited calls and those that become tasks do not count, even if their end is not awaited."""
    node = Node("one")
    task = asyncio.ensure_future(graph.clock.advance(1.0))
    await graph.start(node)
    await asyncio.gather(graph.settle(), graph.stop(node))
    later = asyncio.ensure_future(graph.settle())
    await asyncio.sleep(0)
    assert told() == []
    await asyncio.gather(task, later)
