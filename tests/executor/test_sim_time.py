"""Simulated time: timers, sleeps and deadlines follow /clock."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import CallTimeout, Node, Qos, timer
from graphflow.msgs.rosgraph_msgs.msg import Clock
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.qos import CLOCK
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.testing import Graph
from graphflow.times import NANOSECONDS, Time, to_ns
from tests.cases import slow
from tests.runtime.cast import Log


class World:
    """The publisher of /clock."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.clock: TopicPublisher[Clock] = graph.publisher(Clock, "/clock", CLOCK)

    async def say(self, *seconds: float) -> None:
        for second in seconds:
            self.clock.publish(Clock(clock=Time(to_ns(second))))
            await self.graph.settle()


class Ticker(Node):
    """Counts seconds."""

    def __init__(self, **options: Any) -> None:
        super().__init__("ticker", **options)
        self.ticks: list[float] = []

    @timer(1.0)
    async def tick(self) -> None:
        self.ticks.append(self.clock.now().seconds)


def simulated() -> Ticker:
    return Ticker(use_sim_time=True)


async def test_time_is_what_clock_says(graph: Graph) -> None:
    """Zero until the first message, then its stamp, whatever the wall clock."""
    node = simulated()
    await graph.start(node)
    assert node.clock.time_ns() == 0
    await World(graph).say(100.5)
    await graph.clock.advance(50.0)
    assert node.clock.time_ns() == 100_500_000_000
    assert node.context.cache.topics()["/clock"] == ["rosgraph_msgs/msg/Clock"]


async def test_timers_follow(graph: Graph) -> None:
    """A period is one of simulated seconds, from the first message on; missed ones are skipped."""
    node = simulated()
    await graph.start(node)
    world = World(graph)
    await world.say(100.0, 100.9)
    assert node.ticks == []
    await world.say(101.0, 101.5, 102.0)
    assert node.ticks == [101.0, 102.0]
    await world.say(105.5, 105.9, 106.0)
    assert node.ticks == [101.0, 102.0, 105.5, 106.0]


async def test_a_pause_stops_everything(graph: Graph) -> None:
    """While /clock is silent, or repeats itself, no time passes."""
    node = simulated()
    await graph.start(node)
    world = World(graph)
    await world.say(10.0, 11.0, 11.0, 11.0)
    await graph.clock.advance(100.0)
    assert node.ticks == [11.0]


async def test_a_jump_back_delays_nobody(graph: Graph) -> None:
    """As when a recording restarts: the time of day jumps back, periods continue."""
    node = simulated()
    await graph.start(node)
    world = World(graph)
    await world.say(100.0, 101.0, 101.4)
    await world.say(5.0, 5.5)
    assert node.ticks == [101.0]
    await world.say(5.7)
    assert node.ticks == [101.0, 5.7]
    assert node.clock.now() == Time(to_ns(5.7))


@slow
async def test_sleeps_and_deadlines_follow(graph: Graph) -> None:
    """`clock.sleep`, `clock.timeout`, the deadline of a call and that of a topic count simulated seconds."""
    node, server = simulated(), Node("server")
    events, log = Log(), Log()
    node.create_publisher(Int32, "n", Qos(deadline_ns=2 * NANOSECONDS), on_event=events)
    client = node.create_client(Empty, "never")

    async def never(request: Empty.Request) -> Empty.Response:
        await server.clock.sleep(1e6)
        return Empty.Response()

    server.create_service(Empty, "never", never)

    async def sleeper() -> None:
        await node.clock.sleep(3.0)
        log("slept")

    async def limited() -> None:
        with pytest.raises(TimeoutError):
            async with node.clock.timeout(4.0):
                await node.clock.sleep(1e6)
        log("timed out")

    async def caller() -> None:
        with pytest.raises(CallTimeout):
            await client.call(Empty.Request(), timeout=5.0)
        log("call timed out")

    await graph.start(server, node)
    for work in (sleeper, limited, caller):
        node.spawn(work)
    await graph.clock.advance(1000.0)
    world = World(graph)
    await world.say(50.0, 52.9)
    assert log == []
    await world.say(53.0)
    assert log == ["slept"]
    await world.say(54.0, 55.0)
    assert log == ["slept", "timed out", "call timed out"]
    assert [e.kind for e in events].count("deadline_missed") == 2


async def test_it_can_be_switched_while_running(graph: Graph) -> None:
    """Timers restart on the other clock; sleeps continue for their remaining time."""
    node = Ticker()
    await graph.start(node)
    await graph.clock.advance(1.0)
    assert len(node.ticks) == 1
    node.parameters.set({"use_sim_time": True})
    await graph.settle()
    await graph.clock.advance(10.0)
    assert len(node.ticks) == 1
    world = World(graph)
    await world.say(7.0, 8.0)
    assert node.ticks[1:] == [8.0]

    log = Log()

    async def sleeper() -> None:
        await node.clock.sleep(3.0)
        log("slept")

    node.spawn(sleeper)
    await world.say(9.0)
    node.parameters.set({"use_sim_time": False})
    await graph.clock.advance(1.9)
    assert log == []
    await graph.clock.advance(0.2)
    assert log == ["slept"]
    assert len(node.ticks) == 5
    await world.say(10.0)
    assert node.clock is graph.clock
    assert node.context.cache.endpoints(node_kind(), "/clock", "/ticker") == []


def node_kind() -> Any:
    from graphflow.wire.liveliness import Kind

    return Kind.SUBSCRIPTION


async def test_messages_carry_the_systems_time(graph: Graph) -> None:
    """The source time beside a message is the system's, as in ROS 2, however the node counts."""
    node, listener = simulated(), Node("listener")
    publisher = node.create_publisher(Int32, "n")
    listening = listener.create_subscription(Int32, "n", None)
    await graph.start(node, listener)
    publisher.publish(Int32())
    await graph.settle()
    assert (await listening.next_with_info())[1].source_ns == graph.clock.time_ns()
