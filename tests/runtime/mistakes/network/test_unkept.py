"""Messages that are published once, before their first subscription opens.

The publishers have names that no other test uses: a module that mentions one might publish with it.
"""

from __future__ import annotations

import pytest

from graphflow import Node, Publisher, subscription, task, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import Durability, Qos
from graphflow.runtime.mistakes.network.unkept import WARN_AFTER
from graphflow.testing import Graph
from tests.cases import slow

Caplog = pytest.LogCaptureFixture

LATCHED = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)


class MapServer(Node):
    """Publishes the map once."""

    floor_chart = Publisher(String, "map", 1)

    async def on_start(self) -> None:
        self.floor_chart.publish(String(data="the map"))


class Latched(Node):
    """Keeps it."""

    kept_chart = Publisher(String, "map", LATCHED)

    async def on_start(self) -> None:
        self.kept_chart.publish(String(data="the map"))


class Parts(Node):
    """Publishes it in two parts, one of them in a task."""

    def __init__(self) -> None:
        super().__init__()
        self.chart_parts = self.create_publisher(String, "map", 1)

    async def on_start(self) -> None:
        if self.full_name:
            self.chart_parts.publish(String(data="head"))

    @task
    async def go_on(self) -> None:
        self.chart_parts.publish(String(data="tail"))


class Stopping(Node):
    """Publishes a first command, and others later."""

    cmd_vel = Publisher(String, "map", 1)

    async def on_start(self) -> None:
        self.cmd_vel.publish(String(data="stop"))

    @timer(100.0)
    async def drive(self) -> None:
        self.cmd_vel.publish(String(data="go"))


class Patient(Node):
    """Looks whether somebody hears it."""

    slow_chart = Publisher(String, "map", 1)

    async def on_start(self) -> None:
        self.slow_chart.publish(String(data="loading"))
        self.log.debug("%d", self.slow_chart.get_subscription_count())


class Each(Node):
    """Publishes in a loop."""

    each_chart = Publisher(String, "map", 1)

    @task
    async def send(self) -> None:
        for word in ("a",):
            self.each_chart.publish(String(data=word))


class Two(Node):
    """Publishes now and then."""

    two_charts = Publisher(String, "map", 1)

    @task
    async def send_both(self) -> None:
        self.two_charts.publish(String(data="loading"))
        await self.clock.sleep(60.0)
        self.two_charts.publish(String(data="map"))


class Planner(Node):
    """Hears the map, if it comes."""

    @subscription(String, "map", 1)
    def got(self, message: String) -> None:
        self.log.debug("%s", message.data)


def told(caplog: Caplog) -> list[str]:
    return [text for text in caplog.messages if "not kept" in text]


async def run(graph: Graph, server: Node, *later: Node) -> None:
    await graph.start(server)
    await graph.clock.advance(1.0)
    for node in later:
        await graph.start(node)
        await graph.clock.advance(2 * WARN_AFTER)


@slow
async def test_a_map_before_the_planner(graph: Graph, caplog: Caplog) -> None:
    """Is reported once, with the line that publishes it and the profile that keeps it."""
    await run(graph, MapServer(), Planner(), Planner("other"))
    assert told(caplog) == [
        "/map: the only message was published before the subscription of /planner opened (test_unkept.py:28), and it "
        "is not kept for it; await the publisher's wait_matched() first, publish in a @timer, or give both "
        "Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)"
    ]


async def test_a_map_in_parts(graph: Graph, caplog: Caplog) -> None:
    """Is reported with all lines."""
    await run(graph, Parts(), Planner())
    [text] = told(caplog)
    assert "all 2 messages were published before" in text
    assert "(test_unkept.py:49, test_unkept.py:53), and they are not kept for it; await " in text
    assert "or give both Qos(depth=2, " in text


@pytest.mark.parametrize("kind", [Latched, Stopping, Patient, Each, Two])
async def test_publishers_that_publish_more_or_keep_it(graph: Graph, caplog: Caplog, kind: type[Node]) -> None:
    """Are not reported."""
    await run(graph, kind(), Planner())
    assert told(caplog) == []


async def test_subscriptions_that_were_there_or_are_a_tools(graph: Graph, caplog: Caplog) -> None:
    """Are not reported, nor is one that asks for kept messages, which is told that there are none."""
    await run(graph, Planner("early"), MapServer(), Planner("late"))
    assert told(caplog) == []
    latched = Node("latched")
    latched.create_subscription(String, "b", lambda _: None, LATCHED)
    server = MapServer("b_server", remap=["map:=b"])
    await run(graph, server, latched)
    tool = Node("_tool")
    tool.create_subscription(String, "c", lambda _: None)
    await run(graph, MapServer("c_server", remap=["map:=c"]), tool)
    assert told(caplog) == []


async def test_a_planner_that_has_left(graph: Graph, caplog: Caplog) -> None:
    """Is not reported, nor are nodes that stop meanwhile."""
    server, planner = MapServer(), Planner()
    await graph.start(server)
    await graph.clock.advance(1.0)
    await graph.start(planner)
    await graph.stop(planner)
    await graph.clock.advance(2 * WARN_AFTER)
    server = MapServer("other")
    await graph.start(server)
    await graph.clock.advance(1.0)
    await graph.start(Planner("second"))
    await graph.stop(server)
    await graph.clock.advance(2 * WARN_AFTER)
    assert told(caplog) == []
