"""The groups and threads of callbacks, and the limits of a stop; see also `test_node_groups` and `test_node_core`."""

from __future__ import annotations

import asyncio
import threading

import pytest

from graphflow import Group, Node
from graphflow.runtime import node_work
from graphflow.runtime.node_core import NodeCore, core_of
from graphflow.runtime.node_work import placed
from graphflow.testing import Graph


class Worker(Node):
    slow = Group(1, thread=True)


def core() -> NodeCore:
    return core_of(Worker())


async def later() -> None:
    """Do nothing."""


def test_labels(graph: Graph) -> None:
    """A handler is called as its function, or otherwise as given; without a callback there is no group."""
    node = core()
    assert placed(node, node.groups, later, "timer", None, False)[:2] == ("later", later)
    assert placed(node, node.groups, lambda: None, "timer", None, False)[0] == "timer"
    assert placed(node, node.groups, None, "subscription /in", Worker.slow, False) == ("subscription /in", None, None)


async def test_threads(graph: Graph) -> None:
    """A `def` in a group with threads runs in one; an `async def` does not, and cannot be told to."""
    node = Worker()
    await graph.start(node)
    host = core_of(node)
    _, call, group = placed(host, host.groups, threading.get_ident, "timer", node.slow, False)
    assert await call() != threading.get_ident()
    assert group is node.slow
    assert placed(host, host.groups, later, "timer", node.slow, False)[1] is later
    with pytest.raises(ValueError, match="later: thread=True is for `def`"):
        placed(host, host.groups, later, "timer", None, True)


async def test_a_goodbye_has_a_limit(
    graph: Graph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is cancelled and logged after a limit; the node stops all the same."""
    monkeypatch.setattr(node_work, "STOP_LIMIT", 0.01)

    class Slow(Node):
        async def on_shutdown(self) -> None:
            await asyncio.sleep(60.0)

    slow = Slow()
    await graph.start(slow)
    await core_of(slow).stop()
    assert "on_shutdown took more than 0 s and was cancelled" in caplog.text
    assert not slow.is_running
