"""Topics in a viewer."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import Node
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.viewer import topics
from graphflow.wire.liveliness import Entity, Kind
from tests.viewer.cast import Robot, served, viewer

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_messages(graph: Graph) -> None:
    """Messages are forwarded unchanged with their source time, only while a client is subscribed."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen, viewer(lab.port) as other:
        twist = Twist(linear=Vector3(x=0.5))
        await seen.until(lambda: "/speed" in seen.channels)
        wanted = [{"id": 6, "channelId": 4_000_000}, {"id": 7, "channelId": seen.channels["/speed"]["id"]}]
        await seen.send("subscribe", subscriptions=wanted)  # unsubscribing one does not affect the other
        await seen.until(lambda: robot.speed.get_subscription_count() == 1)
        robot.speed.publish(twist)
        await seen.until(lambda: seen.messages)
        assert seen.messages[0].payload == twist.to_bytes()
        assert (seen.messages[0].subscription, seen.messages[0].log_ns) == (7, graph.clock.time_ns())
        await other.subscribe(1, "/speed")
        await seen.send("unsubscribe", subscriptionIds=[7])
        await other.send("unsubscribe", subscriptionIds=[1])
        await seen.until(lambda: robot.speed.get_subscription_count() == 0)


async def test_a_latched_topic(graph: Graph) -> None:
    """Each new subscription receives the latched message."""
    robot = Robot()
    async with served(graph, robot) as lab:
        robot.map.publish(String(data="a map"))
        for _ in range(2):
            async with viewer(lab.port) as first, viewer(lab.port) as second:
                await first.subscribe(1, "/map")
                await first.until(lambda seen=first: seen.messages)  # type: ignore[misc]
                await second.subscribe(1, "/map")
                await second.until(lambda seen=second: seen.messages)  # type: ignore[misc]


async def test_topics_that_cannot_be_shown(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Topics of undefined types and malformed names are reported once; the others are shown."""
    robot = Robot()
    odd = Node("odd")
    await graph.start(odd)
    core = core_of(odd)
    for name, type_ in (("/speed", "my_pkg/msg/Foo"), ("//a", "std_msgs/msg/String")):
        core.context.cache.apply(
            Entity(0, "ffff", 1, len(name) + 10, Kind.NODE, "/", f"n{len(name)}").token, alive=True
        )
        graph.network.session(asyncio.get_running_loop()).announce(
            Entity(0, "ffff", 1, len(name) + 20, Kind.PUBLISHER, "/", "odd", name, type_, "RIHS01_" + "0" * 64).token
        )
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        await seen.until(lambda: "/speed" in seen.channels)
        assert seen.channels["/speed"]["schemaName"] == "geometry_msgs/msg/Twist"
        before = caplog.text.count("is not shown")
        await graph.start(Node("later"))
        await graph.settle()
        assert caplog.text.count("is not shown") == before
        assert (
            "/speed is not shown: there is no interface package 'my_pkg'; /odd: this node uses no type" in caplog.text
        )


async def test_a_viewer_that_goes(graph: Graph) -> None:
    """The subscriptions of a viewer end with it."""
    robot = Robot()
    async with served(graph, robot) as lab:
        async with viewer(lab.port) as seen:
            await seen.subscribe(1, "/speed")
            await seen.until(lambda: robot.speed.get_subscription_count() == 1)
        await seen.until(lambda: robot.speed.get_subscription_count() == 0)


async def test_bounds(graph: Graph, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    """Topics and subscriptions are limited; a subscription number is unique."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        await seen.until(lambda: {"/speed", "/map"} <= {*seen.channels})
        monkeypatch.setattr(topics, "BOUND", 1)
        await seen.subscribe(1, "/speed")
        await seen.subscribe(1, "/map")
        await seen.subscribe(2, "/map")
        await seen.until(lambda: len(seen.statuses) == 2)
        assert seen.statuses == ["subscription 1 exists already", "a viewer cannot subscribe to more than 1 topics"]
        other = Node("other")
        await graph.start(other)
        other.create_publisher(Twist, "/more")
        await seen.until(lambda: "only 1 topics are shown" in caplog.text)
        assert "/more" not in seen.channels


async def test_hidden_topics(graph: Graph) -> None:
    """They are not shown."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        robot.create_publisher(Twist, "/a/_hidden")
        robot.create_publisher(Twist, "/shown")
        await seen.until(lambda: "/shown" in seen.channels)
        assert "/a/_hidden" not in seen.channels
