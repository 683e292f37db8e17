"""Announcement, matching and closing of endpoints."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import ClosedError, Node, Qos
from graphflow.errors import GraphflowError
from graphflow.msgs import registry
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.qos import SENSOR_DATA
from graphflow.runtime.endpoints.endpoint import COMPLAIN_EVERY, Endpoint
from graphflow.runtime.node_core import core_of
from graphflow.runtime.part import Host
from graphflow.testing import Graph
from graphflow.wire.liveliness import Entity, Kind

STRING = "std_msgs/msg/String"


class Loudspeaker(Endpoint):
    """A publisher without a topic: it declares things that write down when they are closed."""

    kind = Kind.PUBLISHER

    def __init__(self, host: Host, qos: Qos | None = None) -> None:
        super().__init__(host, STRING, "/chatter", Qos() if qos is None else qos)
        self.story: list[str] = []
        self.came: list[tuple[str, bool]] = []

    def _open(self, key: str) -> None:
        self.story.append(f"opened {key}, {len(self.host.context.cache.named(self.name))} there")
        self._declared += [_Declared("first", self.story), _Declared("second", self.story)]

    def _matched(self, other: Entity, alive: bool) -> None:
        self.came.append((other.node_name, alive))


class _Declared:
    def __init__(self, name: str, story: list[str]) -> None:
        self.name, self.story = name, story

    def close(self) -> None:
        self.story.append(f"closed {self.name}")


async def speaking(graph: Graph, qos: Qos | None = None) -> tuple[Node, Loudspeaker]:
    """A node that holds one, at work."""
    node = Node("talker", namespace="/a")
    speaker = core_of(node).add(Loudspeaker(core_of(node), qos))
    await graph.start(node)
    return node, speaker


async def test_an_endpoint_is_announced_as_what_it_is(graph: Graph) -> None:
    """Under its node, its names, its type with the hash of that, and an id of its own."""
    node, speaker = await speaking(graph, Qos(depth=3))
    entity = speaker.entity

    assert entity is not None
    assert (entity.kind, entity.name, entity.type, entity.qos) == (Kind.PUBLISHER, "/chatter", STRING, Qos(depth=3))
    assert (entity.node_name, entity.zid, entity.hash) == (
        "/a/talker",
        node.context.session.zid,
        registry.hash_of(STRING),
    )
    assert entity.token in graph.network.tokens
    assert (repr(speaker), speaker.title) == (f"<Loudspeaker /chatter [{STRING}]>", "publisher /chatter")
    assert speaker.endpoints == (speaker,)


async def test_who_sees_an_endpoint_can_reach_it(graph: Graph) -> None:
    """It is declared before it is announced, and withdrawn in reverse order; closing twice is harmless."""
    _, speaker = await speaking(graph)
    assert speaker.entity is not None
    assert speaker.story == [f"opened {speaker.entity.data_key}, 0 there"]

    token = speaker.entity.token
    speaker.close()
    speaker.close()

    assert speaker.story[1:] == ["closed second", "closed first"]
    assert token not in graph.network.tokens
    assert not speaker.is_open
    assert speaker not in core_of(graph.nodes[0]).endpoints


async def test_counterparts_are_known_while_they_are_there(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Earlier and later ones; endpoints of other topics are not reported."""
    early, late = Node("early"), Node("late")
    for node in (early, late):
        node.create_subscription(String, "/chatter", None)
        node.create_subscription(String, "/news", None)
    await graph.start(early)
    _, speaker = await speaking(graph)
    await graph.start(late)
    assert speaker.came == [("/early", True), ("/late", True)]
    assert {entity.node_name for entity in speaker.matched.values()} == {"/early", "/late"}
    assert speaker.statistics() == {"matched": 2}

    await graph.stop(early)
    assert speaker.came[2:] == [("/early", False)]
    assert speaker.event_total("matched") == 2
    speaker.close()
    await graph.stop(late)
    assert caplog.records == [], "who has closed does not listen"


async def test_an_endpoint_of_a_running_node_reaches_who_is_there(graph: Graph) -> None:
    """At once, as the graph is known by then."""
    listener, node = Node("listener"), Node("talker")
    listener.create_subscription(String, "/chatter", None)
    await graph.start(listener, node)

    speaker = core_of(node).add(Loudspeaker(core_of(node)))

    assert speaker.came == [("/listener", True)]


async def test_waiting_for_counterparts(graph: Graph) -> None:
    """It ends with the last that is wanted, and not before."""
    _, speaker = await speaking(graph)
    waiting = asyncio.create_task(speaker.wait_matched(2))
    for name in ("one", "two"):
        await graph.settle()
        assert not waiting.done()
        node = Node(name)
        node.create_subscription(String, "/chatter", None)
        await graph.start(node)

    await waiting
    await speaker.wait_matched()


async def test_a_wait_for_counterparts_can_be_cancelled(graph: Graph) -> None:
    """Without leaving a reference."""
    _, speaker = await speaking(graph)
    waiting = asyncio.create_task(speaker.wait_matched())
    await graph.settle()
    waiting.cancel()
    await graph.settle()

    assert waiting.cancelled()
    node = Node("late")
    node.create_subscription(String, "/chatter", None)
    await graph.start(node)
    assert len(speaker.matched) == 1


async def test_a_wait_for_counterparts_ends_with_the_node(graph: Graph) -> None:
    """They will never come."""
    node, speaker = await speaking(graph)
    waiting = asyncio.create_task(speaker.wait_matched())
    await graph.settle()
    await graph.stop(node)

    with pytest.raises(ClosedError, match="/chatter was closed while its counterparts were waited for"):
        await waiting


async def test_what_is_not_open_reaches_nobody(graph: Graph) -> None:
    """The error explains where it can be used, before the start and after the stop."""
    node, speaker = await speaking(graph)
    await graph.stop(node)
    for endpoint in (speaker, Loudspeaker(core_of(Node("talker", namespace="/a")))):
        with pytest.raises(ClosedError, match=r"^/chatter: node /a/talker is not running; use this from"):
            await endpoint.wait_matched()


async def test_an_endpoint_that_cannot_be_declared_is_not_announced(graph: Graph) -> None:
    """It is not announced."""

    class Broken(Loudspeaker):
        def _open(self, key: str) -> None:
            raise GraphflowError("no room")

    node = Node("talker")
    core_of(node).add(Broken(core_of(node)))
    with pytest.raises(GraphflowError, match="no room"):
        await graph.start(node)

    assert not graph.network.tokens


async def test_a_counterpart_that_comes_and_goes_is_complained_of_now_and_then(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """It is logged only once per interval."""
    ear, mouth = Node("ear"), Node("mouth")
    ear.create_subscription(String, "/words", lambda _: None, 10)
    await graph.start(ear, mouth)
    for _ in range(5):
        flapping = mouth.create_publisher(Int32, "/words", 10)
        await graph.settle()
        flapping.close()
        await graph.settle()
    told = [m for r in caplog.records if r.name.endswith("ear") and "nothing passes" in (m := r.getMessage())]
    assert len(told) == 1
    await graph.clock.advance(COMPLAIN_EVERY)
    mouth.create_publisher(Int32, "/words", 10)
    await graph.settle()
    assert sum("nothing passes" in r.getMessage() for r in caplog.records if r.name.endswith("ear")) == 2


async def test_two_ends_of_one_node_that_do_not_fit(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The node's log has it once, from the subscription."""
    node = Node("both")
    node.create_subscription(String, "/words", lambda _: None, 10)
    node.create_publisher(Int32, "/words", 10)
    await graph.start(node)
    [text] = [message for message in caplog.messages if "nothing passes" in message]
    assert "the publisher of /both, of type std_msgs/msg/Int32, and the subscription here" in text


async def test_a_subscription_that_asks_for_more_than_a_sensor_offers(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """The complaint of its node has the code to write."""
    ear, mouth = Node("ear"), Node("mouth")
    ear.create_subscription(Int32, "/reading", lambda _: None, 10)
    mouth.create_publisher(Int32, "/reading", SENSOR_DATA)
    await graph.start(ear, mouth)
    [record] = [r for r in caplog.records if r.name.endswith("ear") and "offers less" in r.getMessage()]
    code = 'as in @subscription(Int32, "/reading", SENSOR_DATA), from graphflow.qos'
    assert record.getMessage().endswith(f"have the subscription ask for reliability BEST_EFFORT, {code}")
