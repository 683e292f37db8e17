"""Hooks that take long."""

from __future__ import annotations

import asyncio
import threading

import pytest

from graphflow import LifecycleNode, Node
from graphflow.runtime.mistakes import slow_hooks
from graphflow.runtime.mistakes.slow_hooks import when_slow
from graphflow.runtime.node_core import core_of
from graphflow.runtime.node_options import NodeOptions, make_within
from graphflow.testing import Graph


@pytest.mark.parametrize(
    ("hook", "then"),
    [
        ("on_start", "no handler of this node runs until it returns"),
        ("on_activate", "no handler of this node runs until it returns"),
        ("on_deactivate", "until then, the node can make no other transition"),
    ],
)
async def test_what_waits_for_it_is_told(graph: Graph, caplog: pytest.LogCaptureFixture, hook: str, then: str) -> None:
    """The warning names the consequences: handlers wait for some hooks, only transitions for others."""
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


def test_an_init_that_does_not_return(monkeypatch: pytest.MonkeyPatch) -> None:
    """The warning has the current line; an `__init__` that has returned causes none."""
    monkeypatch.setattr(slow_hooks, "SLOW_INIT", 0.01)
    told, texts = threading.Event(), list[str]()

    def warning(text: str, *args: object) -> None:
        texts.append(text % args)
        told.set()

    monkeypatch.setattr(slow_hooks.logger, "warning", warning)

    class Slow(Node):
        def __init__(self) -> None:
            super().__init__()
            assert told.wait(30.0)

    make_within(Slow, NodeOptions(), "slow")
    [text] = texts
    assert text.startswith("Slow.__init__ has not returned for 0 s, now in test_slow_hooks.py:")
    assert "in __init__, and the node starts when it has" in text


async def test_an_init_on_an_event_loop(graphflow_runner: asyncio.Runner) -> None:
    """It is left to the watch over the loop."""
    with slow_hooks.warn_slow_init(Node):
        assert not any(isinstance(thread, threading.Timer) for thread in threading.enumerate())
