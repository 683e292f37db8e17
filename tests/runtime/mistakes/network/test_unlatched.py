"""Volatile subscriptions that open after the only message of a publisher that keeps it."""

from __future__ import annotations

import pytest

from graphflow import Node, subscription
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import Durability, Qos
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.mistakes.network import unlatched
from graphflow.runtime.mistakes.network.unlatched import ANSWER, WARN_AFTER
from graphflow.testing import Graph

Caplog = pytest.LogCaptureFixture

LATCHED = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)


class Nav(Node):
    """Hears the map, if it comes."""

    heard = 0

    @subscription(String, "map")
    def got(self, message: String) -> None:
        self.heard += 1


def told(caplog: Caplog) -> list[str]:
    return [text for text in caplog.messages if "its only message" in text]


async def server(graph: Graph, name: str = "server", qos: Qos = LATCHED) -> TopicPublisher[String]:
    node = Node(name)
    made = node.create_publisher(String, "map", qos)
    await graph.start(node)
    return made


async def test_a_map_that_was_sent_before(graph: Graph, caplog: Caplog) -> None:
    """Is told once, with the profile that receives it."""
    made = await server(graph)
    made.publish(String(data="map"))
    await graph.clock.advance(1.0)
    nav = Nav()
    await graph.start(nav)
    await graph.clock.advance(WARN_AFTER + ANSWER - 0.1)
    assert told(caplog) == []
    await graph.clock.advance(60.0)
    await server(graph, "other")
    await graph.clock.advance(60.0)
    assert told(caplog) == [
        "/map: /server sent its only message before this subscription opened, and keeps it for late ones that ask for "
        "it; give the subscription Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)"
    ]
    assert nav.heard == 0


async def test_a_subscription_that_was_there_first(graph: Graph, caplog: Caplog) -> None:
    """Is not told, whether it has received the message or the message is not sent yet."""
    made = await server(graph)
    nav = Nav()
    await graph.start(nav)
    await graph.clock.advance(WARN_AFTER + ANSWER / 2)
    made.publish(String(data="map"))
    await graph.clock.advance(60.0)
    assert (nav.heard, told(caplog)) == (1, [])
    await graph.start(Nav("late"))
    await graph.clock.advance(1.0)
    made.publish(String(data="another"))
    await graph.clock.advance(60.0)
    assert told(caplog) == []


async def test_streams_and_those_that_receive_it(graph: Graph, caplog: Caplog) -> None:
    """Are not told: a publisher that has sent more than one message, or keeps none, and a latched subscription."""
    stream = await server(graph)
    for number in range(2):
        stream.publish(String(data=str(number)))
    plain = await server(graph, "plain", Qos())
    plain.publish(String(data="map"))
    expiring = await server(graph, "expiring", Qos(1, durability=Durability.TRANSIENT_LOCAL, lifespan_ns=10**9))
    expiring.publish(String(data="map"))
    await graph.clock.advance(2.0)
    latched = Node("latched")
    latched.create_subscription(String, "map", lambda _: None, LATCHED)
    await graph.start(Nav(), latched)
    hidden = await server(graph, "tools")
    hidden.publish(String(data="map"))
    await graph.clock.advance(1.0)
    await graph.start(Nav("_tool"))
    await graph.clock.advance(60.0)
    assert told(caplog) == []


async def test_a_node_that_stops_meanwhile(graph: Graph, caplog: Caplog) -> None:
    """Is not told."""
    made = await server(graph)
    made.publish(String(data="map"))
    await graph.clock.advance(1.0)
    nav, other = Nav(), Nav("other")
    await graph.start(nav, other)
    await graph.clock.advance(WARN_AFTER / 2)
    await graph.stop(nav)
    await graph.clock.advance(WARN_AFTER / 2 + ANSWER / 2)
    await graph.stop(other)
    await graph.clock.advance(60.0)
    assert told(caplog) == []


async def test_a_flood_of_kept_messages(graph: Graph, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the newest are looked at: here a stream's, and not the map before it."""
    made = await server(graph)
    made.publish(String(data="map"))
    stream = await server(graph, "stream")
    for number in range(2):
        stream.publish(String(data=str(number)))
    await graph.clock.advance(1.0)
    monkeypatch.setattr(unlatched, "ANSWERS_BOUND", 1)
    await graph.start(Nav())
    await graph.clock.advance(WARN_AFTER + 2 * ANSWER)
    assert told(caplog) == []
    monkeypatch.setattr(unlatched, "ANSWERS_BOUND", 2)
    await graph.start(Nav("other"))
    await graph.clock.advance(WARN_AFTER + 2 * ANSWER)
    assert len(told(caplog)) == 1
