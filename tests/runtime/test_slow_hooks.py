"""Hooks that take long."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import LifecycleNode, Node
from graphflow.runtime.core import core_of
from graphflow.runtime.slow_hooks import when_slow
from graphflow.testing import Graph


@pytest.mark.parametrize(
    ("hook", "then"),
    [
        ("on_start", "this node's handlers start when it has"),
        ("on_activate", "this node's handlers start when it has"),
        ("on_deactivate", "until it has, the node can make no other transition"),
    ],
)
async def test_what_waits_for_it_is_told(graph: Graph, caplog: pytest.LogCaptureFixture, hook: str, then: str) -> None:
    """Handlers wait for hooks that begin something, and nothing but other transitions for the rest."""
    node = Node("n")
    await graph.start(node)
    when_slow(core_of(node), hook)
    await graph.clock.advance(5.5)
    assert f"{hook} has not returned for 5 s" in caplog.text
    assert then in caplog.text


async def test_a_hook_that_has_returned(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Is no longer spoken of."""

    class Quick(LifecycleNode):
        async def on_configure(self) -> None:
            await asyncio.sleep(0)

    node = Quick()
    await graph.start(node)
    await node.trigger_configure()
    await graph.clock.advance(6.0)
    assert "has not returned" not in caplog.text
