"""A node's clock: its context's, or /clock while `use_sim_time` is true."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import Node
from graphflow.errors import ClosedError
from graphflow.executor.sim_time import SimClock
from graphflow.msgs.rosgraph_msgs.msg import Clock
from graphflow.qos import CLOCK
from graphflow.runtime.node_clock import TIMELESS, NodeClock
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.times import Time, to_ns


async def test_one_clock_and_the_other(graph: Graph) -> None:
    """The topic is subscribed to once, and only while its time counts."""
    node = Node("n")
    await graph.start(node)
    core = core_of(node)
    clock = NodeClock(core, lambda name: f"/sim{name}", core.add)

    assert clock.current is graph.clock
    for _ in range(2):
        clock.follow(is_simulated=True)
        assert isinstance(clock.current, SimClock)
    assert [e.name for e in core.endpoints if e.type_name == Clock.SCHEMA.name] == ["/sim/clock"]
    graph.publisher(Clock, "/sim/clock", CLOCK).publish(Clock(clock=Time(to_ns(7.0))))
    await graph.settle()
    assert clock.current.time_ns() == to_ns(7.0)

    for _ in range(2):
        clock.follow(is_simulated=False)
        assert clock.current is graph.clock
    assert [e for e in core.endpoints if e.type_name == Clock.SCHEMA.name] == []


def test_before_the_node_runs() -> None:
    """There is no clock yet."""
    core = core_of(Node("n"))

    with pytest.raises(ClosedError, match="/n is not running; use this from on_start, a handler or a task"):
        _ = NodeClock(core, str, core.add).current


async def test_time_that_does_not_begin(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It is a complaint until the time starts, and logged once."""
    node = Node("n", use_sim_time=True)
    await graph.start(node)
    [text] = core_of(node).complaints()
    assert "there is no message on /clock: its clock stands still" in text
    await graph.clock.advance(2.9)
    assert TIMELESS not in caplog.messages
    await graph.clock.advance(10.0)
    assert caplog.messages.count(TIMELESS) == 1
    graph.publisher(Clock, "/clock", CLOCK).publish(Clock(clock=Time(to_ns(7.0))))
    await graph.settle()
    assert core_of(node).complaints() == []


async def test_time_that_begins_or_is_not_wanted(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """There is no warning."""
    begun, left, ended = (Node(name, use_sim_time=True) for name in ("begun", "left", "ended"))
    for node in (begun, left, ended):
        await graph.start(node)
    left.parameters.set({"use_sim_time": False})
    await graph.stop(ended)
    graph.publisher(Clock, "/clock", CLOCK).publish(Clock(clock=Time(to_ns(7.0))))
    await graph.settle()
    await graph.clock.advance(10.0)
    assert TIMELESS not in caplog.messages


async def test_time_that_is_wanted_again(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The limit starts again; waits on the previous clock continue for their remaining time."""
    node = Node("n", use_sim_time=True)
    await graph.start(node)
    sleeping = asyncio.ensure_future(node.clock.sleep(1.0))
    await graph.settle()
    await graph.clock.advance(2.0)
    node.parameters.set({"use_sim_time": False})
    assert not sleeping.done()
    await graph.clock.advance(0.9)
    node.parameters.set({"use_sim_time": True})
    await graph.clock.advance(2.0)
    assert caplog.messages.count(TIMELESS) == 0
    await graph.clock.advance(2.0)
    assert caplog.messages.count(TIMELESS) == 1
    node.parameters.set({"use_sim_time": False})
    await graph.clock.advance(0.2)
    await graph.settle()
    assert sleeping.done()
