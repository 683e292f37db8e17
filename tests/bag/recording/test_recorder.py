"""Recording from a graph."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from graphflow import Node
from graphflow.bag import writer as writing
from graphflow.bag.reader import Bag
from graphflow.bag.recording import recorder as recorder_module
from graphflow.bag.recording.latched import Repeats
from graphflow.bag.recording.recorder import Recorder
from graphflow.bag.topic_choice import Choice
from graphflow.bag.writer import BagWriter
from graphflow.errors import BagError
from graphflow.msgs.rosgraph_msgs.msg import Clock as ClockMessage
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.qos import Durability, Qos
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.testing import Graph
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind
from tests.until import eventually

ALL = Choice(all=True, exclude=frozenset({"/rosout", "/parameter_events"}))


class Session:
    """A recorder at work."""

    def __init__(self, graph: Graph, folder: Path) -> None:
        self.graph, self.folder = graph, folder
        self.node = Node("recorder")
        self.told: list[str] = []
        self.task: asyncio.Task[None]
        self.recorder: Recorder
        self.publishers: list[TopicPublisher[Any]] = []

    async def start(self, choice: Choice = ALL, **options: Any) -> Recorder:
        await self.graph.start(self.node)
        self.recorder = Recorder(self.node, BagWriter(self.folder), choice, on_topic=self.told.append, **options)
        self.task = asyncio.create_task(self.recorder.run())
        await self.graph.settle()
        return self.recorder

    async def end(self) -> Bag:
        self.task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await self.task
        return Bag(self.folder)

    async def until(self, condition: Callable[[], bool]) -> None:
        await eventually(condition)
        await self.graph.settle()


@pytest.fixture
def session(graph: Graph, tmp_path: Path) -> Session:
    return Session(graph, tmp_path / "bag")


async def speaker(graph: Graph, topic: str = "/chatter", qos: Qos | int = 10) -> TopicPublisher[String]:
    node = Node(topic.replace("/", "x").replace("_", ""))
    await graph.start(node)
    return node.create_publisher(String, topic, qos)


async def test_what_is_said_is_recorded(graph: Graph, session: Session) -> None:
    """With the time at which it came and was sent, the publisher's number, its QoS, the type's hash and definition."""
    publisher = await speaker(graph)
    recorder = await session.start()
    for n in range(3):
        publisher.publish(String(data=str(n)))
        await graph.clock.advance(0.5)
    await session.until(lambda: recorder.recorded == 3)
    bag = await session.end()
    assert [String.from_bytes(r.data).data for r in bag.records()] == ["0", "1", "2"]
    first, second, _ = bag.records()
    assert second.log_ns - first.log_ns == 500_000_000
    assert (first.publish_ns, [r.sequence for r in bag.records()]) == (first.log_ns, [1, 2, 3])
    assert bag.contents.topics["/chatter"].qos == (Qos(depth=10),)
    assert bag.contents.topics["/chatter"].definition == "string data\n"
    assert session.told == ["Subscribed to topic '/chatter'"]
    assert (recorder.dropped, recorder.lost, recorder.topics) == (0, 0, 1)


async def test_topics_that_come_later(graph: Graph, session: Session) -> None:
    """Are recorded from then on, or not, if that was asked for."""
    recorder = await session.start()
    publisher = await speaker(graph)
    await session.until(lambda: recorder.topics == 1)
    publisher.publish(String(data="late"))
    await session.until(lambda: recorder.recorded == 1)
    assert (await session.end()).contents.counts == {"/chatter": 1}


async def test_no_discovery(graph: Graph, session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only what was there at the start."""
    monkeypatch.setattr(recorder_module, "SEARCH_EVERY", 0.0)
    await speaker(graph)
    recorder = await session.start(discovery=False)
    await speaker(graph, "/news")
    for _ in range(3):  # a search takes several turns of the loop
        await graph.settle()
    assert recorder.topics == 1
    assert (await session.end()).contents.counts == {"/chatter": 0}


async def test_only_what_was_chosen(graph: Graph, session: Session) -> None:
    """The others are not even listened to."""
    publishers = [await speaker(graph, topic) for topic in ("/a", "/b", "/_hidden")]
    recorder = await session.start(Choice(regex="/[ab]", exclude=frozenset({"/b"})))
    for publisher in publishers:
        publisher.publish(String())
    await session.until(lambda: recorder.recorded == 1)
    assert [publisher.get_subscription_count() for publisher in publishers] == [1, 0, 0]
    assert (await session.end()).contents.counts == {"/a": 1}


async def test_what_is_kept_for_late_ones(graph: Graph, session: Session) -> None:
    """Is recorded, with the QoS by which it will be kept again when it is played."""
    latched = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)
    (await speaker(graph, "/map", latched)).publish(String(data="map"))
    recorder = await session.start()
    await session.until(lambda: recorder.recorded == 1)
    bag = await session.end()
    assert bag.contents.topics["/map"].qos[0].durability is Durability.TRANSIENT_LOCAL


async def test_a_type_nobody_installed(graph: Graph, session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its definition comes from the publisher, and messages that came before it are not lost."""
    from graphflow.bag.formats import definitions
    from graphflow.errors import UnknownInterface

    def unknown(name: str) -> str:
        raise UnknownInterface(f"there is no interface package {name!r}")

    publisher = await speaker(graph)
    monkeypatch.setattr(definitions, "known", unknown)
    recorder = await session.start()
    publisher.publish(String(data="early"))
    await session.until(lambda: recorder.recorded == 1)
    bag = await session.end()
    assert bag.contents.topics["/chatter"].definition == "string data\n"
    assert bag.contents.counts == {"/chatter": 1}


async def test_a_type_nobody_knows(graph: Graph, session: Session, caplog: pytest.LogCaptureFixture) -> None:
    """Is recorded without its definition, which is told."""
    node = Node("stranger", start_parameter_services=False)
    await graph.start(node)
    publisher = raw.advertise(node, "lab_msgs/msg/Thing", "/things", Qos(), type_hash="RIHS01_ab")
    recorder = await session.start()
    publisher.publish(b"\0\1\0\0thing")
    await session.until(lambda: recorder.recorded == 1)
    bag = await session.end()
    topic = bag.contents.topics["/things"]
    assert (topic.type, topic.hash, topic.definition) == ("lab_msgs/msg/Thing", "RIHS01_ab", "")
    assert "/things is recorded without the definition of lab_msgs/msg/Thing: there is no interface" in caplog.text


async def test_pausing(graph: Graph, session: Session) -> None:
    """Messages during a pause are left out, and do not count as lost."""
    publisher = await speaker(graph)
    recorder = await session.start()
    for is_paused in (False, True, False):
        recorder.is_paused = is_paused
        publisher.publish(String(data=str(is_paused)))
        await graph.settle()
    await session.until(lambda: recorder.recorded == 2)
    assert recorder.lost == 0
    assert [String.from_bytes(r.data).data for r in (await session.end()).records()] == ["False", "False"]


async def test_what_never_arrives_is_counted(graph: Graph, session: Session) -> None:
    """By the gaps in a publisher's numbers."""
    publisher = await speaker(graph)
    recorder = await session.start()
    publisher.publish(String())
    publisher._order.number += 5
    publisher.publish(String())
    await session.until(lambda: recorder.recorded == 2)
    assert recorder.lost == 5
    await session.end()


async def test_a_disk_that_cannot_keep_up(graph: Graph, session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """Messages for which the cache has no room are dropped and counted; the others are written."""
    publisher = await speaker(graph, qos=1000)
    gate = asyncio.Event()
    loop = asyncio.get_running_loop()
    real, is_held_up = BagWriter.add, threading.Event()

    def slowly(self: BagWriter, record: Any) -> None:
        is_held_up.set()
        asyncio.run_coroutine_threadsafe(gate.wait(), loop).result(5.0)
        real(self, record)

    monkeypatch.setattr(BagWriter, "add", slowly)
    recorder = await session.start(cache=10_000)
    for n in range(100):
        publisher.publish(String(data=str(n) * 500))
        if n == 0:
            await session.until(is_held_up.is_set)
    await session.until(lambda: recorder.recorded + recorder.dropped == 100)
    assert recorder.dropped > 50
    gate.set()
    bag = await session.end()
    assert bag.contents.message_count == 100 - recorder.dropped


async def test_a_full_disk(graph: Graph, session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """It ends the recording with a reason, and what was recorded can be read."""
    room = 20_000
    real = writing._Stream._put

    def put(stream: Any, data: memoryview) -> int:
        nonlocal room
        if len(data) > room:
            room = 1 << 20  # the reserve
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        room -= len(data)
        return real(stream, data)

    monkeypatch.setattr(writing._Stream, "_put", put)
    monkeypatch.setattr(writing, "CHUNK_SIZE", 1000)
    monkeypatch.setattr(recorder_module, "WRITE_EVERY", 0.005)
    publisher = await speaker(graph, qos=1000)
    recorder = await session.start()
    for n in range(200):
        publisher.publish(String(data=os.urandom(500).hex()))
        await graph.settle()
        if n % 20 == 0:  # by and by, as messages come
            await session.until(lambda: not recorder._queue or recorder.failed.done())
    await session.until(recorder.failed.done)
    with pytest.raises(BagError, match="the disk is full"):
        await session.task
    bag = Bag(session.folder)
    assert bag.contents.is_whole
    assert len(list(bag.records())) == bag.contents.message_count > 10


async def test_snapshots(graph: Graph, session: Session) -> None:
    """Nothing is written before one is taken, and then the last messages that the cache holds."""
    publisher = await speaker(graph, qos=1000)
    recorder = await session.start(snapshot=True, cache=4000)
    for n in range(20):
        publisher.publish(String(data=f"{n:03}" + "x" * 90))
    await session.until(lambda: recorder.recorded == 20)
    assert Bag(session.folder).contents.message_count == 0
    assert recorder.take_snapshot()
    await session.until(lambda: bool(session.node) and Bag(session.folder).contents.message_count > 0)
    publisher.publish(String(data="after"))
    bag = await session.end()
    assert [String.from_bytes(r.data).data[:3] for r in bag.records()] == [f"{n:03}" for n in range(9, 20)]
    assert recorder.dropped == 0


async def test_a_rate(graph: Graph, session: Session) -> None:
    """One topic is recorded so often, others as they come; nothing counts as lost."""
    often, other = await speaker(graph), await speaker(graph, "/other")
    recorder = await session.start(rates={"/chatter": 2.0})
    for n in range(20):
        often.publish(String(data=str(n)))
        other.publish(String())
        await graph.clock.advance(0.1)
    await session.until(lambda: recorder.recorded == 24)
    assert recorder.unused_options == []
    bag = await session.end()
    assert bag.contents.counts == {"/chatter": 4, "/other": 20}
    assert (recorder.lost, recorder.dropped) == (0, 0)


async def test_options_of_topics_that_are_not_recorded(graph: Graph, session: Session) -> None:
    """They are named with the nearest topic, but not where the topic itself is reported as missing."""
    await speaker(graph)
    recorder = await session.start(
        Choice(topics=frozenset({"/chatter", "/late"})), rates={"/chater": 2.0, "/late": 1.0}
    )
    await session.until(lambda: recorder.topics == 1)
    assert recorder.unused_options == ["/chater has a rate, but is not recorded; did you mean '/chatter'?"]


async def test_what_every_snapshot_begins_with(graph: Graph, tmp_path: Path) -> None:
    """The last message of a latched topic, though the cache has it no more; once, if it has it."""
    node = Node("recorder")
    await graph.start(node)
    latched = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)
    (await speaker(graph, "/map", latched)).publish(String(data="map"))
    publisher = await speaker(graph, qos=1000)
    writer = BagWriter(tmp_path / "bag", repeats=Repeats(latched=1))
    recorder = Recorder(node, writer, ALL, snapshot=True, cache=4000, on_topic=lambda _: None)
    task = asyncio.create_task(recorder.run())
    await graph.settle()
    for taken, count in ((21, 20), (41, 20)):
        for _ in range(count):
            publisher.publish(String(data="x" * 90))
        await eventually(lambda: recorder.recorded >= taken)  # noqa: B023 - it is called at once
        recorder.take_snapshot()
        await eventually(lambda: not recorder._is_writing_snapshot)
    task.cancel()
    with contextlib.suppress(asyncio.CancelledError):
        await task
    bag = Bag(tmp_path / "bag")
    assert bag.contents.counts["/map"] == 2
    first = next(bag.records())
    assert first.topic.name == "/map"


async def test_splitting(graph: Graph, session: Session) -> None:
    """Later messages are in a new file, earlier ones in the old one, written already or not."""
    publisher = await speaker(graph)
    recorder = await session.start()
    with recorder._work:  # so that nothing is written yet
        publisher.publish(String(data="one"))
        await session.until(lambda: recorder.recorded == 1)
        recorder.split()
    await session.until(lambda: len(list(session.folder.glob("*.mcap"))) == 2)
    publisher.publish(String(data="two"))
    await session.until(lambda: recorder.recorded == 2)
    bag = await session.end()
    assert [part.contents.message_count for part in bag.parts] == [1, 1]
    assert not recorder.take_snapshot()


async def test_many_publishers_of_one_topic(graph: Graph, session: Session, caplog: pytest.LogCaptureFixture) -> None:
    """Each has numbers of its own; what is of another type is left out, which is told."""
    one, two = await speaker(graph), Node("two")
    await graph.start(two)
    other = two.create_publisher(String, "/chatter", Qos(depth=3))
    recorder = await session.start()
    wrong = two.create_publisher(Int32, "/chatter")
    for n in range(5):
        one.publish(String(data="a"))
        if n % 2:
            other.publish(String(data="b"))
        wrong.publish(Int32(data=n))
    await session.until(lambda: recorder.recorded == 7)
    assert recorder.lost == 0
    await session.until(lambda: "/chatter is of type std_msgs/msg/Int32, too; only std_msgs/msg/String" in caplog.text)
    assert len((await session.end()).contents.topics["/chatter"].qos) == 2


async def test_what_others_may_say(graph: Graph, session: Session, caplog: pytest.LogCaptureFixture) -> None:
    """A type that is none, or a time before all time, ends no recording."""
    node = Node("stranger", start_parameter_services=False)
    await graph.start(node)
    publisher = await speaker(graph)
    recorder = await session.start()
    odd = publisher.entity
    assert odd is not None
    recorder._consider(odd._replace(name="/odd", type="foo\x1b[2J", zid="ff"))
    recorder._arrived("/chatter", b"\0\1\0\0", MessageInfo(1, -1, bytes(16)))
    publisher.publish(String(data="fine"))
    await session.until(lambda: recorder.recorded == 2)
    bag = await session.end()
    assert [r.publish_ns == r.log_ns for r in bag.records()] == [True, True]
    assert "/odd cannot be recorded: " in caplog.text
    assert "\x1b" not in caplog.text


async def test_a_full_disk_without_discovery(graph: Graph, session: Session) -> None:
    """Ends it, too."""
    await speaker(graph)
    recorder = await session.start(discovery=False)
    recorder._fail(BagError("the disk is full"))
    with pytest.raises(BagError, match="the disk is full"):
        await asyncio.wait_for(session.task, 5.0)


async def test_an_error_of_the_writer(graph: Graph, session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever it is, it ends the recording, and is told even where the bag cannot be finished."""

    def broken(self: BagWriter, *_: object) -> None:
        raise RuntimeError("broken")

    publisher = await speaker(graph)
    await session.start()
    monkeypatch.setattr(BagWriter, "add", broken)
    monkeypatch.setattr(BagWriter, "salvage", broken)
    monkeypatch.setattr(threading, "excepthook", lambda _: None)
    publisher.publish(String())
    with pytest.raises(BagError, match="broken"):
        await asyncio.wait_for(session.task, 5.0)
    session.recorder._writer._reserve.close()
    session.recorder._writer._part.abandon()


async def test_what_waits_for_a_definition_is_bounded(
    graph: Graph, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the cache, for all topics together; and what has been let go counts no more."""
    gate = asyncio.Event()

    async def slowly(node: Node, entity: Any) -> str:
        await gate.wait()
        return ""

    monkeypatch.setattr(recorder_module, "fetch", slowly)
    one = await speaker(graph)
    recorder = await session.start(cache=3000)
    for _ in range(20):
        one.publish(String())
        await graph.settle()
    held = 20 - recorder.dropped
    assert 5 < held < 12
    gate.set()
    await session.until(lambda: recorder.recorded == held)
    gate.clear()
    two = await speaker(graph, "/news")
    await session.until(lambda: recorder.topics == 2)
    before = recorder.dropped
    two.publish(String())
    await graph.settle()
    assert recorder.dropped == before
    gate.set()
    await session.end()


async def test_what_its_own_queues_have_dropped(graph: Graph, session: Session) -> None:
    """Is among what is told at the end."""
    await speaker(graph)
    recorder = await session.start()
    [subscription] = recorder._subscriptions.values()
    assert subscription._inbox is not None
    subscription._inbox.dropped = 5
    await session.end()
    assert recorder.dropped == 5


async def test_what_it_says_itself(graph: Graph, session: Session) -> None:
    """Is not recorded."""
    recorder = await session.start()
    session.node.create_publisher(String, "/own")
    await speaker(graph)
    await session.until(lambda: recorder.topics == 1)
    assert (await session.end()).contents.counts == {"/chatter": 0}


async def test_another_definition_of_a_type_that_is_known(
    graph: Graph, session: Session, caplog: pytest.LogCaptureFixture
) -> None:
    """Is not recorded with the one that is known here."""
    node = Node("stranger", start_parameter_services=False)
    await graph.start(node)
    raw.advertise(node, "std_msgs/msg/String", "/t", Qos(), type_hash="RIHS01_ab")
    recorder = await session.start()
    await session.until(lambda: recorder.topics == 1 and not recorder._undefined)
    topic = (await session.end()).contents.topics["/t"]
    assert (topic.hash, topic.definition) == ("RIHS01_ab", "")
    assert "its definition here differs" in caplog.text


async def test_topics_by_who_is_there(graph: Graph, session: Session) -> None:
    """Topics with subscriptions only are included, or topics without subscriptions left out."""
    node = Node("listener")
    await graph.start(node)
    node.create_subscription(String, "/wanted", lambda _: None)
    await speaker(graph, "/alone")
    recorder = await session.start(unpublished=True, leaves=False)
    await session.until(lambda: recorder.topics == 1)
    assert (await session.end()).contents.counts == {"/wanted": 0}


async def test_other_profiles(graph: Graph, session: Session) -> None:
    """A topic is listened to with the profile that was given for it."""
    await speaker(graph)
    await speaker(graph, "/other")
    recorder = await session.start(qos={"/chatter": Qos(depth=3)})
    await session.until(lambda: recorder.topics == 2)
    assert recorder._subscriptions["/chatter"].qos.depth == 3
    assert recorder._subscriptions["/other"].qos.depth == 1000
    await session.end()


async def test_simulated_time(graph: Graph, session: Session) -> None:
    """Nothing is recorded before it has begun, which is told once."""
    publisher = await speaker(graph)
    session.node = Node("recorder", use_sim_time=True)
    recorder = await session.start(Choice(topics=frozenset({"/chatter"})))
    clock = graph.publisher(ClockMessage, "/clock")
    await graph.settle()
    for _ in range(2):
        publisher.publish(String(data="early"))
    await graph.settle()
    clock.publish(ClockMessage(clock={"sec": 1000}))
    await graph.settle()
    publisher.publish(String(data="now"))
    await session.until(lambda: recorder.recorded == 1)
    bag = await session.end()
    assert [(r.log_ns, String.from_bytes(r.data).data) for r in bag.records()] == [(1000 * 10**9, "now")]
    assert session.told.count("Waiting for the first message on /clock; nothing is recorded before it") == 1


async def test_a_name_that_is_none(graph: Graph, session: Session, caplog: pytest.LogCaptureFixture) -> None:
    """Ends no recording, whoever has announced it."""
    token = Entity(0, "ffff", 1, 20, Kind.PUBLISHER, "/", "odd", "//a", "std_msgs/msg/String", "RIHS01_" + "0" * 64)
    graph.network.session(asyncio.get_running_loop()).announce(token.token)
    await speaker(graph)
    recorder = await session.start()
    await session.until(lambda: recorder.topics == 1)
    assert "cannot be recorded" in caplog.text
    await session.end()


async def test_too_many_publishers_to_count_for(
    graph: Graph, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The gaps of those beyond the limit are not counted; their messages are recorded."""
    monkeypatch.setattr(recorder_module, "SENDERS_BOUND", 1)
    first, second = await speaker(graph, "/a"), await speaker(graph, "/b")
    recorder = await session.start()
    first.publish(String())
    await session.until(lambda: recorder.recorded == 1)
    for publisher in (second, first):
        publisher.publish(String())
        publisher._order.number += 5
        publisher.publish(String())
    await session.until(lambda: recorder.recorded == 5)
    assert recorder.lost == 5
    await session.end()
