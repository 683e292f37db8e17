"""Bags as typed messages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow import Node
from graphflow.bag import BagMessage, read
from graphflow.bag.contents import Topic
from graphflow.bag.typed import decoder
from graphflow.errors import BagError, DecodeError
from graphflow.msgs import registry
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.testing import Graph
from tests.bag.cast import CHATTER, LAB, START, THING, record, write


def test_messages(tmp_path: Path) -> None:
    """With topic and time, in their order; some topics, some time."""
    folder = write(tmp_path / "bag")
    first, second, *_ = read(folder)
    assert first == BagMessage("/map", String(data="map"), START)
    assert second.message == String(data="hello 0")
    numbers = [said.message for said in read(folder, ["/count"], start_ns=START + 10**9)]
    assert numbers == [Int32(data=n) for n in range(10, 20)]


def test_topics_by_name(tmp_path: Path) -> None:
    """One may stand alone, and without its slash; one that is not there is told at once, with the nearest."""
    folder = write(tmp_path / "bag")
    assert list(read(folder, "count")) == list(read(folder, ["/count"]))
    with pytest.raises(BagError, match="no topic /cont; did you mean '/count'"):
        read(folder, ["/cont"])


def test_a_type_that_is_nowhere_installed(tmp_path: Path) -> None:
    """Is made of the definition in the bag."""
    [said] = read(write(tmp_path / "bag", [record(LAB, THING, 0.0)]))
    assert (said.message.x, list(said.message.part.y)) == (7, [1, 2])


def test_the_calls_of_a_service(tmp_path: Path) -> None:
    """Are of a type that is in no file, and follows from the service's."""
    name = "example_interfaces/srv/AddTwoInts_Event"
    event: Any = registry.interface_class(name)()
    topic = Topic("/add/_service_event", name, registry.hash_of(name))
    [said] = read(write(tmp_path / "bag", [record(topic, event, 0.0)]))
    assert said.message == event


@pytest.mark.parametrize(
    ("topic", "message"),
    [
        (LAB._replace(type="example_interfaces/srv/AddTwoInts_Nothing", definition=""), "the bag has no definition"),
        (LAB._replace(type="a/b/c", definition=""), "the bag has no definition"),
        (LAB._replace(type="nowhere_msgs/msg/A", definition=""), "the bag has no definition of it"),
        (LAB._replace(type="nowhere_msgs/msg/A", definition="int32 class"), "definition cannot be used"),
        (
            LAB._replace(type="nowhere_msgs/msg/A", definition="int32 x", hash="RIHS01_00"),
            "not RIHS01_00, which was announced",
        ),
        (LAB._replace(type="nowhere", definition=""), "is not an interface name"),
        (
            CHATTER._replace(hash="RIHS01_00"),
            "recorded with another definition of std_msgs/msg/String than the one here",
        ),
        (CHATTER._replace(encoding="json"), "its messages are serialized as 'json', not as CDR"),
    ],
)
def test_types_that_cannot_be_made(topic: object, message: str) -> None:
    """Say why."""
    with pytest.raises(BagError, match=message):
        decoder(topic)  # type: ignore[arg-type]


def test_a_message_that_is_none(tmp_path: Path) -> None:
    """Is an error when its turn comes."""
    folder = write(tmp_path / "bag", [record(CHATTER, String(data="a"), 0.0), record(CHATTER, b"\0\1\0\0\xff", 1.0)])
    said = read(folder)
    assert next(said).message == String(data="a")
    with pytest.raises(DecodeError):
        next(said)


async def test_a_node_is_fed_from_a_bag(graph: Graph, tmp_path: Path) -> None:
    """Under the manual clock, so that a test takes no time however long the recording is."""
    node, heard = Node("listener"), list[tuple[float, str]]()
    await graph.start(node)
    node.create_subscription(String, "chatter", lambda m: heard.append((node.clock.monotonic_ns() / 1e9, m.data)))
    publisher = graph.publisher(String, "/chatter")
    began, at = node.clock.monotonic_ns() / 1e9, START
    for said in read(write(tmp_path / "bag"), ["/chatter"]):
        await graph.clock.advance((said.time_ns - at) / 1e9)
        at = said.time_ns
        publisher.publish(said.message)
        await graph.settle()
    assert [text for _, text in heard] == [f"hello {n}" for n in range(20)]
    assert heard[-1][0] - began == pytest.approx(1.9)


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("data", "did you mean .message?"),
        ("stamp", "did you mean .time_ns?"),
        ("child_frame_id", "it is a field of its message: write .message.child_frame_id"),
    ],
)
def test_names_of_others(name: str, hint: str) -> None:
    """Fields of the message, and words of other libraries, are answered; anything else is as in Python."""
    from graphflow.msgs.nav_msgs.msg import Odometry

    told = BagMessage("/odom", Odometry(), 1)
    with pytest.raises(AttributeError) as caught:
        getattr(told, name)
    assert str(caught.value) == f"'BagMessage' object has no attribute {name!r}; {hint}"
    assert not hasattr(told, "zzz")
    topic, message, time_ns = told
    assert (topic, message, time_ns) == ("/odom", Odometry(), 1)
