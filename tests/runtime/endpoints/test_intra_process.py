"""Messages between nodes of one process."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest

from graphflow import EncodeError, Node, Qos
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import Durability, Liveliness
from graphflow.runtime.context import Context
from graphflow.runtime.endpoints.intra_process import Handed
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.transport.memory import Network
from tests.runtime.cast import Log

LATCHED = Qos(durability=Durability.TRANSIENT_LOCAL)


class Wire:
    """Count messages on the network."""

    def __init__(self, network: Network) -> None:
        self.sent = 0
        network.carrier = self

    def carry(self, deliver: Any, link: str, *, is_lossy: bool = False) -> None:
        self.sent += is_lossy
        deliver()


async def together(graph: Graph, *nodes: Node) -> Wire:
    """Start nodes in one process; returns the counter of their messages on the network."""
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    for node in nodes:
        await core_of(node).start(context)
        graph.nodes.append(node)
    await graph.settle()
    return Wire(graph.network)


def pair(qos: Qos | int = 10, other: Qos | int = 10, kind: Any = String) -> tuple[Node, Node, Any, Log]:
    heard = Log()
    speaker, listener = Node("speaker", enable_rosout=False), Node("listener", enable_rosout=False)
    listener.create_subscription(kind, "chatter", heard, other)
    return speaker, listener, speaker.create_publisher(kind, "chatter", qos), heard


async def test_nothing_goes_over_the_network(graph: Graph) -> None:
    """Without subscriptions in other processes; the publisher still knows that it is wanted."""
    speaker, listener, publisher, heard = pair()
    wire = await together(graph, speaker, listener)
    assert publisher.is_wanted
    publisher.publish(String(data="hello"))
    await graph.settle()
    assert [m.data for m in heard] == ["hello"]
    assert wire.sent == 0
    assert (publisher.published, publisher.get_subscription_count()) == (1, 1)


async def test_others_hear_it_too(graph: Graph) -> None:
    """Once each, whether they share the process or not, and with the same sequence numbers."""
    speaker, listener, publisher, heard = pair()
    wire = await together(graph, speaker, listener)
    tap = graph.tap(String, "/chatter")
    await graph.settle()
    for word in ("one", "two"):
        publisher.publish(String(data=word))
    await graph.settle()
    assert [m.data for m in heard] == [m.data for m in tap] == ["one", "two"]
    assert wire.sent >= 2


@pytest.mark.parametrize("qos", [10, LATCHED], ids=["volatile", "latched"])
@pytest.mark.parametrize("other", [10, LATCHED], ids=["volatile", "latched"])
async def test_every_pair_hears_a_message_once(graph: Graph, qos: Qos | int, other: Qos | int) -> None:
    """Also where the network keeps messages for late subscriptions; by hand unless both are latched."""
    speaker, listener, publisher, heard = pair(qos, other)
    wire = await together(graph, speaker, listener)
    publisher.publish(String(data="hello"))
    await graph.settle()
    assert [m.data for m in heard] == ["hello"]
    assert wire.sent == (qos is LATCHED and other is LATCHED)


async def test_a_late_subscription_gets_what_was_latched(graph: Graph) -> None:
    """Once."""
    speaker, listener, publisher, heard = pair(LATCHED, LATCHED)
    await together(graph, speaker, listener)
    publisher.publish(String(data="hello"))
    late = Log()
    listener.create_subscription(String, "chatter", late, LATCHED)
    await graph.settle()
    assert [m.data for m in late] == [m.data for m in heard] == ["hello"]


async def test_each_receiver_has_a_message_of_its_own(graph: Graph) -> None:
    """A receiver may change or keep its message, and the publisher may modify the original."""
    speaker, listener, publisher, heard = pair()
    listener.create_subscription(String, "chatter", lambda m: setattr(m, "data", m.data + "!"), 10)
    kept = Log()
    listener.create_subscription(String, "chatter", kept, 10)
    await together(graph, speaker, listener)
    message = String(data="hello")
    publisher.publish(message)
    message.data = "changed"
    await graph.settle()
    assert [m.data for m in (*heard, *kept)] == ["hello", "hello"]


async def test_a_large_array_is_not_copied(graph: Graph) -> None:
    """Receivers share it, read-only."""
    speaker, listener, publisher, heard = pair(kind=Image)
    listener.create_subscription(Image, "chatter", heard, 10)
    await together(graph, speaker, listener)
    pixels = bytes(1_000_000)
    publisher.publish(Image(data=pixels))
    await graph.settle()
    first, second = heard
    assert first is not second
    assert np.shares_memory(first.data, second.data)
    assert np.shares_memory(first.data, np.frombuffer(pixels, np.uint8))
    assert not first.data.flags.writeable


async def test_a_wrong_message_is_an_error_here_too(graph: Graph) -> None:
    """It is neither delivered nor counted."""
    speaker, listener, publisher, heard = pair()
    await together(graph, speaker, listener)
    wrong: Any = String()
    wrong.data = 5
    with pytest.raises(EncodeError, match=r"String.data: expected string, got 5"):
        publisher.publish(wrong)
    await graph.settle()
    assert (len(heard), publisher.published) == (0, 0)


async def test_queues_are_bounded(graph: Graph) -> None:
    """As for messages from elsewhere: the oldest are dropped, and counted."""
    speaker, listener, publisher, heard = pair(other=3)
    await together(graph, speaker, listener)
    subscription = next(e for e in listener.endpoints if e.name == "/chatter")
    for i in range(10):
        publisher.publish(String(data=str(i)))
    await graph.settle()
    assert [m.data for m in heard] == ["7", "8", "9"]
    assert subscription.statistics()["dropped"] == 7


async def test_a_subscription_that_wants_no_local_messages(graph: Graph) -> None:
    """It gets none by hand either."""
    speaker, listener, publisher, heard = pair()
    deaf = Log()
    listener.create_subscription(String, "chatter", deaf, 10, ignore_local=True)
    await together(graph, speaker, listener)
    publisher.publish(String(data="hello"))
    await graph.settle()
    assert (len(heard), len(deaf)) == (1, 0)


async def test_a_closed_subscription_gets_nothing(graph: Graph) -> None:
    """And a publisher whose last subscription has gone is not wanted."""
    speaker, listener, publisher, heard = pair()
    await together(graph, speaker, listener)
    next(e for e in listener.endpoints if e.name == "/chatter").close()
    assert not publisher.is_wanted
    publisher.publish(String(data="hello"))
    await graph.settle()
    assert heard == []


async def test_a_message_of_another_type_stays_apart(graph: Graph) -> None:
    """One name and two types are two topics, also within a process."""
    speaker, listener, _, heard = pair()
    other: TopicPublisher[Image] = speaker.create_publisher(Image, "chatter")
    await together(graph, speaker, listener)
    assert not other.is_wanted
    other.publish(Image())
    await graph.settle()
    assert heard == []


async def test_a_publisher_and_subscription_of_one_node(graph: Graph) -> None:
    """A node hears itself, as in ROS 2, also through a remap."""
    heard = Log()
    node = Node("alone", remap=["out:=in"], enable_rosout=False)
    node.create_subscription(String, "in", heard)
    publisher = node.create_publisher(String, "out")
    wire = await together(graph, node)
    publisher.publish(String(data="me"))
    await graph.settle()
    assert [m.data for m in heard] == ["me"]
    assert wire.sent == 0


def test_the_last_receiver_gets_the_copy_itself() -> None:
    """The others get copies of it: for one receiver there is one copy."""
    original = String(data="a")
    made: list[String] = []

    def clone(message: String) -> String:
        made.append(String(data=message.data))
        return made[-1]

    handed = Handed(original, (1, 2, bytes(16)), 3, clone)
    assert [handed.take(), handed.take()] == made
    assert handed.take() is original


SECOND = 1_000_000_000


async def test_a_message_that_waited_too_long(graph: Graph) -> None:
    """Has outlived its lifespan here, too."""
    speaker, listener = Node("speaker", enable_rosout=False), Node("listener", enable_rosout=False)
    listening = listener.create_subscription(String, "chatter", None, Qos(lifespan_ns=SECOND))
    publisher = speaker.create_publisher(String, "chatter")
    await together(graph, speaker, listener)
    publisher.publish(String(data="old"))
    await graph.clock.advance(2.0)
    publisher.publish(String(data="new"))
    assert (await anext(aiter(listening))).data == "new"
    assert listening.expired == 1


async def test_a_publisher_is_alive_whose_message_waits(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The reader is late, and not the publisher, also within a process."""
    manual = Qos(liveliness=Liveliness.MANUAL_BY_TOPIC, lease_ns=SECOND)
    speaker, listener = Node("speaker", enable_rosout=False), Node("listener", enable_rosout=False)
    changes: list[int] = []
    listening = listener.create_subscription(
        String,
        "chatter",
        None,
        Qos(lease_ns=SECOND, liveliness=Liveliness.MANUAL_BY_TOPIC),
        on_event=lambda event: changes.append(event.current) if event.kind == "liveliness_changed" else None,
    )
    publisher = speaker.create_publisher(String, "chatter", manual)
    await together(graph, speaker, listener)
    publisher.publish(String(data="here"))
    await graph.clock.advance(1.5)
    assert (changes, caplog.text) == ([1], "")
    assert (await anext(aiter(listening))).data == "here"
    await graph.clock.advance(1.5)
    assert changes == [1, 0]
