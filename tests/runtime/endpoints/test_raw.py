"""Serialized messages, of types that are known here or not."""

from __future__ import annotations

import pytest

from graphflow import Node
from graphflow.errors import ClosedError, DecodeError, UnknownInterface
from graphflow.msgs import registry
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import BEST_AVAILABLE, DEFAULT, Durability, Qos
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import RawPublisher, RawSubscription
from graphflow.testing import Graph
from graphflow.wire.attachment import MessageInfo

HELLO = String(data="hello").to_bytes()
STRING = "std_msgs/msg/String"


class Heard:
    def __init__(self) -> None:
        self.payloads: list[bytes] = []
        self.infos: list[MessageInfo] = []

    def __call__(self, payload: bytes, info: MessageInfo) -> None:
        self.payloads.append(payload)
        self.infos.append(info)


async def pair(
    graph: Graph, type_name: str = STRING, type_hash: str = "", qos: Qos = DEFAULT
) -> tuple[RawPublisher, RawSubscription, Heard]:
    here, there, heard = Node("here"), Node("there"), Heard()
    await graph.start(here, there)
    subscription = raw.subscribe(there, type_name, "/t", heard, qos, type_hash=type_hash)
    publisher = raw.advertise(here, type_name, "/t", qos, type_hash=type_hash)
    await publisher.wait_matched()
    return publisher, subscription, heard


async def test_what_is_sent_arrives_as_it_is(graph: Graph) -> None:
    """With the sequence number, time and sender of each message; messages are not decoded."""
    publisher, subscription, heard = await pair(graph)
    publisher.publish(HELLO)
    publisher.publish(b"no message at all")
    await graph.settle()
    assert heard.payloads == [HELLO, b"no message at all"]
    assert [info.sequence for info in heard.infos] == [1, 2]
    assert publisher.entity is not None
    assert {info.gid for info in heard.infos} == {publisher.entity.gid}
    assert (publisher.published, subscription.received, subscription.dropped) == (2, 2, 0)
    assert publisher.statistics()["published"] == 2
    assert subscription.statistics()["received"] == 2


async def test_a_type_that_is_not_known(graph: Graph) -> None:
    """Its name and hash are enough."""
    publisher, subscription, heard = await pair(graph, "lab_msgs/msg/Thing", "RIHS01_ab")
    publisher.publish(b"\0\1\0\0thing")
    await graph.settle()
    assert heard.payloads == [b"\0\1\0\0thing"]
    assert publisher.entity is not None
    assert (publisher.entity.type, publisher.entity.hash) == ("lab_msgs/msg/Thing", "RIHS01_ab")
    assert subscription.type_hash == "RIHS01_ab"


async def test_with_others(graph: Graph) -> None:
    """Publishers and subscriptions of messages are their counterparts."""
    node, other, heard, said = Node("a"), Node("b"), Heard(), list[str]()
    await graph.start(node, other)
    publisher = raw.advertise(node, STRING, "/up", DEFAULT)
    raw.subscribe(node, STRING, "/down", heard, BEST_AVAILABLE)
    other.create_subscription(String, "/up", lambda message: said.append(message.data))
    speaker = other.create_publisher(String, "/down")
    await graph.settle()
    publisher.publish(HELLO)
    speaker.publish(String(data="hello"))
    await graph.settle()
    assert said == ["hello"]
    assert heard.payloads == [HELLO]


async def test_within_a_process(graph: Graph) -> None:
    """Messages are delivered as objects; invalid ones are refused."""
    node, heard, said = Node("a"), Heard(), list[str]()
    await graph.start(node)
    raw.subscribe(node, STRING, "/t", heard, DEFAULT)
    node.create_subscription(String, "/t", lambda message: said.append(message.data))
    raw.advertise(node, STRING, "/t", DEFAULT).publish(HELLO)
    node.create_publisher(String, "/t").publish(String(data="hello"))
    await graph.settle()
    assert heard.payloads == [HELLO, HELLO]
    assert said == ["hello", "hello"]
    with pytest.raises(DecodeError):
        raw.advertise(node, STRING, "/t", DEFAULT).publish(b"no message")


async def test_what_is_kept_for_late_ones(graph: Graph) -> None:
    """As any TRANSIENT_LOCAL publisher does."""
    qos = Qos(depth=3, durability=Durability.TRANSIENT_LOCAL)
    publisher, _, _ = await pair(graph, qos=qos)
    publisher.publish(HELLO)
    late, heard = Node("late"), Heard()
    await graph.start(late)
    raw.subscribe(late, STRING, "/t", heard, qos)
    await graph.settle()
    assert heard.payloads == [HELLO]


async def test_a_burst(graph: Graph) -> None:
    """All of it arrives where the queue is long enough; the oldest go where not, and are counted."""
    publisher, subscription, heard = await pair(graph, qos=Qos(depth=300))
    for _ in range(500):
        publisher.publish(HELLO)
    await graph.settle()
    assert len(heard.payloads) == 300
    assert subscription.dropped == 200


async def test_after_the_end(graph: Graph) -> None:
    """No message arrives, and none can be sent."""
    publisher, subscription, heard = await pair(graph)
    publisher.publish(HELLO)
    subscription.close()
    await graph.settle()
    assert heard.payloads == []
    publisher.close()
    with pytest.raises(ClosedError):
        publisher.publish(HELLO)
    assert registry.hash_of(STRING) == subscription.type_hash


async def test_what_is_no_type(graph: Graph) -> None:
    """Is refused before anything is opened."""
    node = Node("a")
    await graph.start(node)
    with pytest.raises(UnknownInterface, match="is not an interface name"):
        raw.subscribe(node, "foo\x1b", "/t", Heard(), DEFAULT)
    with pytest.raises(UnknownInterface, match="'a/b' is not an interface name"):
        raw.advertise(node, "a/b", "/t", DEFAULT)


async def test_one_that_is_closed_within_a_process(graph: Graph) -> None:
    """It receives no more messages."""
    node, heard = Node("a"), Heard()
    await graph.start(node)
    publisher = node.create_publisher(String, "/t")
    subscription = raw.subscribe(node, STRING, "/t", heard, DEFAULT)
    assert publisher.is_wanted
    subscription.close()
    assert not publisher.is_wanted
