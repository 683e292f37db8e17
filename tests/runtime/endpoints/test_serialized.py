"""Endpoints of serialized messages; more about them in `test_raw.py`."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import ClosedError, Node, Qos
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import Durability
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.serialized import AT_ONCE, UNKNOWN
from graphflow.testing import Graph
from graphflow.wire.attachment import MessageInfo

STRING = "std_msgs/msg/String"
HELLO = String(data="hello").to_bytes()


async def test_bytes_arrive_as_they_were_sent(graph: Graph) -> None:
    """Also within a process, where messages are handed over."""
    node, other = Node("n"), Node("other")
    heard: list[bytes] = []
    for each in (node, other):
        raw.subscribe(each, "std_msgs/msg/String", "/x", lambda payload, _: heard.append(payload), Qos(10))
    publisher = raw.advertise(node, "std_msgs/msg/String", "/x", Qos(10))
    await graph.start(node, other)
    payload = String(data="hello").to_bytes()
    publisher.publish(payload)
    await graph.settle()
    assert heard == [payload] * 2
    assert publisher.statistics()["published"] == 1


@pytest.mark.parametrize("durability", [Durability.VOLATILE, Durability.TRANSIENT_LOCAL])
async def test_a_message_within_a_process_comes_once(graph: Graph, durability: Durability) -> None:
    """By intra-process delivery, with its publication time; each receiver may modify its copy."""
    node, qos = Node("n"), Qos(10, durability=durability)
    heard, words = list[MessageInfo](), list[str]()

    def change(message: String) -> None:
        words.append(message.data)
        message.data = "changed"

    await graph.start(node)
    for _ in range(2):
        node.create_subscription(String, "/x", change, qos)
    raw.subscribe(node, STRING, "/x", lambda _, info: heard.append(info), qos)
    publisher = raw.advertise(node, STRING, "/x", qos)
    await graph.clock.advance(2.0)
    publisher.publish(HELLO)
    await graph.settle()
    assert [(info.sequence, info.source_ns) for info in heard] == [(1, graph.clock.time_ns())]
    assert words == ["hello"] * 2


async def test_the_time_goes_over_the_network(graph: Graph) -> None:
    """Beside the number and the sender."""
    here, there, heard = Node("here"), Node("there"), list[MessageInfo]()
    await graph.start(here, there)
    raw.subscribe(there, STRING, "/x", lambda _, info: heard.append(info), Qos(10))
    publisher = raw.advertise(here, STRING, "/x", Qos(10))
    await graph.clock.advance(2.0)
    publisher.publish(HELLO)
    await graph.settle()
    assert publisher.entity is not None
    assert heard == [MessageInfo(1, graph.clock.time_ns(), publisher.entity.gid)]


@pytest.mark.parametrize("beside", [b"", b"of another layout"])
async def test_messages_without_an_attachment(graph: Graph, beside: bytes) -> None:
    """They are delivered; the missing fields are zero."""
    node, heard = Node("n"), list[Any]()
    await graph.start(node)
    subscription = raw.subscribe(node, STRING, "/x", lambda *given: heard.append(given), Qos(10))
    assert subscription.entity is not None
    session = graph.network.session(asyncio.get_running_loop())
    session.open_sender(subscription.entity.data_key, Qos()).put(HELLO, attachment=beside)
    await graph.settle()
    assert heard == [(HELLO, UNKNOWN)]


async def test_others_have_a_turn_between_many_messages(graph: Graph) -> None:
    """So many are handed on at once."""
    node, turns, heard = Node("n"), list[int](), list[bytes]()
    await graph.start(node)
    subscription = raw.subscribe(node, STRING, "/x", lambda payload, _: heard.append(payload), Qos(1000))
    publisher = raw.advertise(node, STRING, "/x", Qos(1000))
    assert subscription._inbox is not None
    subscription._inbox.ready = lambda: None
    for _ in range(2 * AT_ONCE + 1):
        publisher.publish(HELLO)
    subscription._arrived()
    asyncio.get_running_loop().call_soon(lambda: turns.append(len(heard)))
    await graph.settle()
    assert (turns, len(heard)) == ([2 * AT_ONCE], 2 * AT_ONCE + 1)


async def test_a_publisher_that_is_closed(graph: Graph) -> None:
    """It sends no messages, not even to this process, and counts none."""
    node, heard = Node("n"), list[bytes]()
    await graph.start(node)
    raw.subscribe(node, STRING, "/x", lambda payload, _: heard.append(payload), Qos(10))
    publisher = raw.advertise(node, STRING, "/x", Qos(10))
    publisher.close()
    with pytest.raises(ClosedError):
        publisher.publish(HELLO)
    await graph.settle()
    assert (heard, publisher.published) == ([], 0)
