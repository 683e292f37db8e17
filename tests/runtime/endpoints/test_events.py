"""QoS events of endpoints: matches, incompatibilities, losses, deadlines, liveliness, lifespan."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from graphflow import Liveliness, MessageInfo, Node, Publisher, Qos, QosEvent, Subscription, subscription
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.qos import SENSOR_DATA, Durability
from graphflow.runtime.endpoints.events import SilenceTimer
from graphflow.testing import Graph, ManualClock
from graphflow.wire import attachment
from tests.runtime.cast import Log

SECOND = 10**9
LATCHED = Qos(durability=Durability.TRANSIENT_LOCAL)


def kinds(events: list[QosEvent]) -> list[str]:
    return [e.kind for e in events]


async def test_both_sides_notice_who_comes_and_goes(graph: Graph) -> None:
    """A publisher and a subscription report each other's node, and the current number."""
    talker, listener = Node("talker"), Node("listener")
    ours, theirs = Log(), Log()
    publisher = talker.create_publisher(String, "chatter", on_event=ours)
    listening = listener.create_subscription(String, "chatter", None, on_event=theirs)
    await graph.start(talker, listener)

    assert ours == [QosEvent("matched", 1, 1, 1, "/listener")]
    assert theirs[0] == QosEvent("matched", 1, 1, 1, "/talker")
    assert (publisher.get_subscription_count(), listening.get_publisher_count()) == (1, 1)

    await graph.stop(listener)
    assert ours[1:] == [QosEvent("matched", 1, -1, 0, "/listener")]
    assert publisher.get_subscription_count() == 0


async def test_two_types_on_one_topic_are_reported_on_both_sides(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """A publisher and a subscription of different types do not match; both report it."""
    talker, listener = Node("talker"), Node("listener")
    ours, theirs = Log(), Log()
    publisher = talker.create_publisher(String, "chatter", on_event=ours)
    listener.create_subscription(Int32, "chatter", None, on_event=theirs)
    await graph.start(talker, listener)

    assert ours == [QosEvent("incompatible_type", 1, detail="/listener")]
    assert theirs == [QosEvent("incompatible_type", 1, detail="/talker")]
    assert publisher.get_subscription_count() == 0
    said = [r.getMessage() for r in caplog.records if r.levelno == logging.WARNING]
    assert len(said) == 2
    assert all("std_msgs/msg/String" in text and "std_msgs/msg/Int32" in text for text in said)


async def test_less_than_asked_for_is_reported_and_delivered(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A best-effort publisher and a reliable subscription: a warning on both sides, and the messages pass."""
    talker, listener = Node("talker"), Node("listener")
    heard, events = Log(), Log()
    publisher = talker.create_publisher(String, "chatter", SENSOR_DATA)
    listener.create_subscription(String, "chatter", lambda m: heard(m.data), on_event=events)
    await graph.start(talker, listener)
    publisher.publish(String(data="hello"))
    await graph.settle()

    assert heard == ["hello"]
    assert QosEvent("incompatible_qos", 1, detail="reliability") in events
    assert sum("reliability" in r.getMessage() for r in caplog.records) == 2


async def test_a_gap_in_the_sequence_is_a_loss(graph: Graph) -> None:
    """Missing numbers are counted and reported, separately for each publisher."""
    listener = Node("listener")
    events = Log()
    listening = listener.create_subscription(String, "chatter", None, 100, on_event=events)
    await graph.start(listener)
    network_sender = graph.network.session(listener.context.loop).open_sender(listening.entity.data_key, Qos())  # type: ignore[union-attr]
    for gid, sequence in ((b"a", 5), (b"b", 1), (b"a", 6), (b"a", 9), (b"b", 2), (b"a", 4)):
        network_sender.put(String(data="x").to_bytes(), attachment=attachment.pack(sequence, 0, gid * 16))
    for _ in range(6):
        await listening.next_with_info()
    await graph.settle()

    assert listening.lost == 2
    assert events == [QosEvent("message_lost", 2, 2)]


async def test_what_the_full_queue_drops_is_no_loss(graph: Graph) -> None:
    """Messages dropped here leave gaps too; they are counted as dropped and not as lost."""
    talker, listener = Node("talker"), Node("listener")
    publisher = talker.create_publisher(Int32, "n")
    listening = listener.create_subscription(Int32, "n", None, 2)
    await graph.start(talker, listener)
    publisher.publish(Int32(data=0))
    await graph.settle()
    assert (await listening.next_with_info())[1].sequence == 1
    for i in range(1, 6):
        publisher.publish(Int32(data=i))
    await graph.settle()

    assert [(await listening.next_with_info())[0].data for _ in range(2)] == [4, 5]
    assert (listening.dropped, listening.lost) == (3, 0)


async def test_nobody_listens_so_nothing_is_encoded(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a subscription only the first message is encoded, but each is counted: the first heard is number 3."""
    talker, listener = Node("talker"), Node("listener")
    publisher = talker.create_publisher(Int32, "n")
    await graph.start(talker)
    encoded: list[Any] = []
    encode = publisher._codec.encode

    def counted(message: Any) -> bytes:
        encoded.append(message)
        return encode(message)

    monkeypatch.setattr(publisher._codec, "encode", counted)
    publisher.publish(Int32(data=1))
    publisher.publish(Int32(data=2))
    assert encoded == [Int32(data=1)]

    listening = listener.create_subscription(Int32, "n", None)
    await graph.start(listener)
    publisher.publish(Int32(data=3))
    await graph.settle()

    message, info = await listening.next_with_info()
    assert (message.data, info.sequence) == (3, 3)
    assert len(encoded) == 2


async def test_a_latched_topic_is_kept_for_those_who_come_later(graph: Graph) -> None:
    """A TRANSIENT_LOCAL publisher encodes even without a subscription."""
    talker, listener = Node("talker"), Node("listener")
    publisher = talker.create_publisher(Int32, "n", LATCHED)
    await graph.start(talker)
    publisher.publish(Int32(data=7))
    listening = listener.create_subscription(Int32, "n", None, LATCHED)
    await graph.start(listener)
    assert (await listening.next_with_info())[0].data == 7


async def test_messages_that_outlived_their_lifespan_are_dropped(graph: Graph) -> None:
    """A late subscription to a latched topic receives only messages within the publisher's lifespan."""
    talker, late = Node("talker"), Node("late")
    publisher = talker.create_publisher(Int32, "n", Qos(durability=Durability.TRANSIENT_LOCAL, lifespan_ns=2 * SECOND))
    await graph.start(talker)
    for i in range(4):
        publisher.publish(Int32(data=i))
        await graph.clock.advance(1.0)
    heard = Log()
    await graph.start(late)
    listening = late.create_subscription(Int32, "n", lambda m: heard(m.data), LATCHED)
    await graph.settle()

    assert heard == [2, 3]
    assert listening.expired == 2


async def test_a_subscription_may_ask_for_fresh_messages_only(graph: Graph) -> None:
    """Its own lifespan counts too, for messages that waited in its queue."""
    talker, listener = Node("talker"), Node("listener")
    publisher = talker.create_publisher(Int32, "n")
    listening = listener.create_subscription(Int32, "n", None, Qos(lifespan_ns=SECOND))
    await graph.start(talker, listener)
    publisher.publish(Int32(data=1))
    await graph.clock.advance(1.5)
    publisher.publish(Int32(data=2))
    await graph.settle()

    assert (await listening.next_with_info())[0].data == 2
    assert listening.expired == 1


async def test_a_missed_deadline_is_told_to_both_sides(graph: Graph) -> None:
    """Each period without a message counts, at the publisher and at the subscription."""
    talker, listener = Node("talker"), Node("listener")
    ours, theirs = Log(), Log()
    deadline = Qos(deadline_ns=SECOND)
    publisher = talker.create_publisher(Int32, "n", deadline, on_event=ours)
    listening = listener.create_subscription(Int32, "n", lambda m: None, deadline, on_event=theirs)
    await graph.start(talker, listener)
    for _ in range(3):
        publisher.publish(Int32())
        await graph.clock.advance(0.9)
    assert "deadline_missed" not in kinds(ours) + kinds(theirs)

    await graph.clock.advance(2.0)
    assert kinds(ours).count("deadline_missed") == kinds(theirs).count("deadline_missed") == 2
    assert publisher.event_total("deadline_missed") == 2

    await graph.stop(talker)
    await graph.clock.advance(5.0)
    assert listening.event_total("deadline_missed") == 2, "there is nobody left who promised anything"


async def test_automatic_liveliness_is_that_of_the_process(graph: Graph) -> None:
    """A publisher is alive for as long as it is in the graph."""
    talker, listener = Node("talker"), Node("listener")
    events = Log()
    talker.create_publisher(Int32, "n")
    listener.create_subscription(Int32, "n", None, on_event=events)
    await graph.start(listener, talker)
    await graph.clock.advance(100.0)
    await graph.stop(talker)

    changes = [e for e in events if e.kind == "liveliness_changed"]
    assert [(e.change, e.current, e.detail) for e in changes] == [(1, 1, "/talker"), (-1, 0, "/talker")]


async def test_manual_liveliness_must_be_asserted(graph: Graph) -> None:
    """A publisher that neither publishes nor asserts within its lease is dead to both sides, until it speaks."""
    manual = Qos(liveliness=Liveliness.MANUAL_BY_TOPIC, lease_ns=SECOND)
    talker, listener = Node("talker"), Node("listener")
    ours, theirs = Log(), Log()
    publisher = talker.create_publisher(Int32, "n", manual, on_event=ours)
    listener.create_subscription(Int32, "n", lambda m: None, manual, on_event=theirs)
    await graph.start(talker, listener)

    def alive() -> list[int]:
        return [e.current for e in theirs if e.kind == "liveliness_changed"]

    publisher.publish(Int32())
    await graph.clock.advance(0.8)
    publisher.assert_liveliness()
    await graph.clock.advance(0.8)
    assert alive() == [1]

    await graph.clock.advance(0.5)
    assert alive() == [1, 0]
    assert "liveliness_lost" in kinds(ours)

    publisher.assert_liveliness()
    await graph.settle()
    assert alive() == [1, 0, 1]
    await graph.clock.advance(1.5)
    publisher.publish(Int32())
    await graph.settle()
    assert alive() == [1, 0, 1, 0, 1]


async def test_a_late_handler_does_not_make_the_publisher_dead(graph: Graph) -> None:
    """Messages that wait in the queue are signs of life."""
    manual = Qos(liveliness=Liveliness.MANUAL_BY_TOPIC, lease_ns=SECOND)
    talker, listener = Node("talker"), Node("listener")
    events = Log()
    publisher = talker.create_publisher(Int32, "n", manual)
    listener.create_subscription(Int32, "n", None, manual, on_event=events)
    await graph.start(talker, listener)
    publisher.publish(Int32())
    await graph.clock.advance(1.5)

    assert [e.current for e in events if e.kind == "liveliness_changed"] == [1]


async def test_a_process_can_ignore_itself(graph: Graph) -> None:
    """With ignore_local a subscription hears others only."""
    node, other = Node("node"), Node("other")
    ours, theirs = node.create_publisher(Int32, "n"), other.create_publisher(Int32, "n")
    heard = Log()
    node.create_subscription(Int32, "n", lambda m: heard(m.data), ignore_local=True)
    await graph.start(node, other)
    ours.publish(Int32(data=1))
    theirs.publish(Int32(data=2))
    await graph.settle()
    assert heard == [2]


async def test_a_handler_may_ask_who_sent_it(graph: Graph) -> None:
    """A handler with a third argument gets the message's sequence number, time and sender."""

    class Listener(Node):
        def __init__(self) -> None:
            super().__init__()
            self.infos: list[MessageInfo] = []

        @subscription(Int32, "n")
        async def heard(self, message: Int32, info: MessageInfo) -> None:
            self.infos.append(info)

    listener = Listener()
    await graph.start(listener)
    publisher = graph.publisher(Int32, "/n")
    await graph.settle()
    publisher.publish(Int32())
    await graph.settle()

    (info,) = listener.infos
    assert publisher.entity is not None
    assert info == MessageInfo(1, graph.clock.time_ns(), publisher.entity.gid)


async def test_declared_endpoints_have_events_too(graph: Graph) -> None:
    """A method named by `on_event` is called, `async def` or not; a child class may replace it."""

    class Base(Node):
        def __init__(self) -> None:
            super().__init__()
            self.noticed: list[Any] = []

        def note(self, event: QosEvent) -> None:
            self.noticed.append(("note", event.kind))

        async def note_later(self, event: QosEvent) -> None:
            self.noticed.append(("later", event.kind))

        out = Publisher(Int32, "a", on_event=note)
        into = Subscription(Int32, "b", on_event=note_later)

        @subscription(Int32, "a", on_event=note)
        def heard(self, message: Int32) -> None: ...

    class Child(Base):
        def note(self, event: QosEvent) -> None:
            self.noticed.append(("child", event.kind))

    node = Child()
    await graph.start(node)
    graph.publisher(Int32, "/b")
    await graph.settle()

    assert node.noticed.count(("child", "matched")) == 2
    assert ("later", "matched") in node.noticed
    assert not [who for who, _ in node.noticed if who == "note"]


async def test_an_error_in_an_event_method_is_logged(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It is reported like that of any handler, and the node goes on."""
    node = Node("node")

    def wrong(event: QosEvent) -> None:
        raise ValueError("no")

    node.create_publisher(Int32, "n", on_event=wrong)
    node.create_subscription(Int32, "n", None)
    await graph.start(node)
    assert "event matched of /n: ValueError: no" in caplog.text
    assert node.is_running


async def test_a_watchdog_bites_once_a_silent_period(graph: Graph) -> None:
    """It calls after each whole period since the last touch, and not once it is stopped."""
    clock: ManualClock = graph.clock
    bites: list[float] = []
    timer = SilenceTimer(clock, SECOND, lambda: bites.append(clock.monotonic_ns() / SECOND))
    timer.start()
    await clock.advance(0.6)
    timer.touch()
    await clock.advance(3.0)
    assert bites == [1.6, 2.6, 3.6]
    timer.stop()
    await clock.advance(5.0)
    assert len(bites) == 3
