"""Publishers and subscriptions at work."""

from __future__ import annotations

import asyncio
import itertools
import logging
import threading
from collections.abc import Callable
from random import Random
from typing import Any

import pytest

from graphflow import (
    Node,
    Qos,
    Subscription,
    subscription,
)
from graphflow.errors import ClosedError
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.qos import INFINITE_NS, Durability, History
from graphflow.runtime.endpoints import subscriptions
from graphflow.runtime.endpoints.sources import Source
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.mistakes.losses import MANY_LOSSES
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.transport import inbox as inbox_module
from graphflow.wire import attachment
from tests.cases import slow
from tests.runtime.cast import Log, Speaker, nothing


async def test_what_is_published_is_heard(graph: Graph) -> None:
    """Every subscription of the topic gets every message, in order, and counts it."""
    first, second = Speaker("first"), Node("second")
    log = Log()
    listening = second.create_subscription(String, "chatter", lambda message: log(message.data))
    await graph.start(first, second)

    for word in ("one", "two"):
        first.chatter.publish(String(data=word))
    await graph.settle()

    assert log == ["one", "two"]
    assert listening.received == 2
    assert listening.dropped == 0
    assert first.chatter.published == 2
    assert first.chatter.get_subscription_count() == 2
    assert listening.get_publisher_count() == 1


@slow
async def test_a_handler_may_be_a_coroutine_or_not(graph: Graph) -> None:
    """`def`, `async def` and a `def` in a thread are all called with each message."""
    log: list[tuple[str, bool]] = []
    done = asyncio.Event()
    loop = asyncio.get_running_loop()

    class Listener(Node):
        @subscription(String, "chatter")
        def plain(self, message: String) -> None:
            log.append(("plain", threading.current_thread() is threading.main_thread()))

        @subscription(String, "chatter")
        async def on_the_loop(self, message: String) -> None:
            await asyncio.sleep(0)
            log.append(("loop", threading.current_thread() is threading.main_thread()))

        @subscription(String, "chatter", thread=True)
        def in_a_thread(self, message: String) -> None:
            log.append(("thread", threading.current_thread() is threading.main_thread()))
            loop.call_soon_threadsafe(done.set)

    await graph.start(Listener())
    graph.publisher(String, "/chatter").publish(String())
    await done.wait()
    await graph.settle()

    assert sorted(log) == [("loop", True), ("plain", True), ("thread", False)]


async def test_a_thread_handler_runs_one_at_a_time(graph: Graph) -> None:
    """A blocking body holds its slot, not the loop: the next message waits for it and other handlers do not."""
    gate, entered = threading.Event(), asyncio.Event()
    loop = asyncio.get_running_loop()
    log: list[str] = []

    class Listener(Node):
        @subscription(String, "slow", thread=True)
        def slow(self, message: String) -> None:
            log.append(f"+{message.data}")
            loop.call_soon_threadsafe(entered.set)
            gate.wait(30)
            log.append(f"-{message.data}")

        @subscription(String, "quick")
        async def quick(self, message: String) -> None:
            log.append(message.data)
            gate.set()

    await graph.start(Listener())
    for data in "ab":
        graph.publisher(String, "/slow").publish(String(data=data))
    await entered.wait()
    entered.clear()
    graph.publisher(String, "/quick").publish(String(data="quick"))
    await entered.wait()
    while "-b" not in log:
        await asyncio.sleep(0)

    assert log == ["+a", "quick", "-a", "+b", "-b"]


async def test_a_subscription_can_be_iterated(graph: Graph) -> None:
    """`async for` gives the messages that came and then those that come, and ends with the subscription."""
    node = Speaker()
    await graph.start(node)
    log: list[str] = []

    async def read() -> None:
        async for message in node.heard:
            log.append(message.data)

    node.chatter.publish(String(data="before"))
    await graph.settle()
    reader = asyncio.create_task(read())
    await graph.settle()
    node.chatter.publish(String(data="after"))
    await graph.settle()
    assert log == ["before", "after"]
    node.heard.close()

    await reader
    assert node.heard.received == 2


async def test_an_iteration_can_be_cancelled_and_begun_again(graph: Graph) -> None:
    """A cancelled wait loses no message."""
    node = Speaker()
    await graph.start(node)
    waiting = asyncio.ensure_future(anext(aiter(node.heard)))
    await graph.settle()
    waiting.cancel()
    await graph.settle()
    assert waiting.cancelled()

    node.chatter.publish(String(data="later"))
    await graph.settle()

    assert (await anext(aiter(node.heard))).data == "later"


async def test_a_wait_that_is_cancelled_counts_no_message(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also when it is cancelled while it lets the loop go on, which it does now and then with messages at hand."""
    monkeypatch.setattr(subscriptions, "SLICE", 0.0)
    node = Speaker()
    await graph.start(node)
    messages = aiter(node.heard)
    for count in range(1, 5):
        node.chatter.publish(String(data=str(count)))
        await graph.settle()
        waiting = asyncio.ensure_future(anext(messages))
        await asyncio.sleep(0)
        assert waiting.cancel()
        await asyncio.wait([waiting])
        assert (await anext(messages)).data == str(count)
        assert node.heard.received == count


async def test_two_may_iterate_over_one_subscription(graph: Graph) -> None:
    """Each message goes to one of them, neither waits for ever, and one that is cancelled takes none along."""
    node = Speaker()
    await graph.start(node)
    first, second, third = (asyncio.ensure_future(anext(aiter(node.heard))) for _ in range(3))
    await graph.settle()
    second.cancel()
    await graph.settle()
    node.chatter.publish(String(data="one"))
    await graph.settle()
    node.chatter.publish(String(data="two"))
    await graph.settle()

    assert second.cancelled()
    assert {first.result().data, third.result().data} == {"one", "two"}


async def test_what_comes_beside_a_message(graph: Graph) -> None:
    """Sequence number, time and sender of each message can be had with it."""
    node = Speaker()
    await graph.start(node)
    await graph.clock.advance(1.5)
    for _ in range(2):
        node.chatter.publish(String(data="x"))

    await node.heard.next_with_info()
    message, info = await node.heard.next_with_info()

    assert message == String(data="x")
    assert info.sequence == 2
    assert info.source_ns == graph.clock.now().nanoseconds
    assert node.chatter.entity is not None
    assert info.gid == node.chatter.entity.gid


async def test_a_message_without_attachment_is_heard(graph: Graph) -> None:
    """Its message is delivered with an anonymous sender."""
    node = Speaker()
    await graph.start(node)
    raw_sender(graph, node.heard)(String(data="x").to_bytes(), b"")

    message, info = await node.heard.next_with_info()

    assert message.data == "x"
    assert info == (0, 0, bytes(16))


async def test_only_one_of_callback_and_iteration(graph: Graph) -> None:
    """The error about iterating a subscription with a callback has the correct form."""
    node = Node("n")
    subscribed = node.create_subscription(String, "x", lambda _: None)

    with pytest.raises(ClosedError, match="has a callback; make another one"):
        aiter(subscribed)


async def test_a_full_queue_drops_the_oldest_and_counts(graph: Graph) -> None:
    """With depth 3 the newest three of ten remain, and seven losses are counted."""
    node = Speaker()
    await graph.start(node)
    for n in range(10):
        node.chatter.publish(String(data=str(n)))
    await graph.settle()

    assert [(await anext(aiter(node.heard))).data for _ in range(3)] == ["7", "8", "9"]
    assert (node.heard.received, node.heard.dropped) == (10, 7)


async def test_a_busy_handler_drops_the_oldest_and_counts(graph: Graph) -> None:
    """Messages that arrive during a run wait in the queue, up to its depth."""
    node, gate, log = Node("n"), asyncio.Event(), Log()

    async def slow(message: Int32) -> None:
        log(message.data)
        await gate.wait()

    subscribed = node.create_subscription(Int32, "x", slow, 2)
    await graph.start(node)
    publisher = graph.publisher(Int32, "/x")
    publisher.publish(Int32(data=0))
    await graph.settle()
    for n in range(1, 6):
        publisher.publish(Int32(data=n))
    await graph.settle()
    gate.set()
    await graph.settle()

    assert log == [0, 4, 5]
    assert (subscribed.received, subscribed.dropped) == (6, 3)


class Reader(Node):
    """A node that has a subscription, and may read it."""

    x = Subscription(Int32, "x", 3)
    newest = Subscription(Int32, "newest", 1)

    async def read(self) -> None:
        async for _ in self.x:
            pass


async def flood(graph: Graph, subscription: TopicSubscription[Int32], topic: str, read: Callable[[int], bool]) -> None:
    """Publish 300 messages; one is read after each whose number `read` accepts."""
    publisher = graph.publisher(Int32, topic)
    for n in range(300):
        publisher.publish(Int32(data=n))
        await graph.settle()
        if read(n):
            await anext(subscription)


async def test_a_subscription_that_nobody_reads_is_told(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Nothing in the class can read it."""
    node = Node("n")
    subscription = node.create_subscription(Int32, "x", None, 1)
    await graph.start(node)
    await flood(graph, subscription, "/x", lambda _: False)
    [told] = caplog.messages
    text = f"nothing has read /x yet, and its messages are lost, {MANY_LOSSES} so far: write `async for"
    assert told.startswith(text)


async def test_a_loop_that_is_too_slow_is_told(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It loses some messages between all that it reads."""
    node = Reader()
    await graph.start(node)
    await flood(graph, node.x, "/x", lambda n: n % 3 == 0)
    [told] = caplog.messages
    assert "most messages are lost" in told
    assert "faster than they are read. Do less in the loop, have less sent, or keep only the newest" in told


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("newest", lambda n: n % 3 == 0),  # only the newest is wanted
        ("newest", lambda n: n < 20),  # and only in some states
        ("x", lambda n: n < 10 or 100 <= n < 110 or 200 <= n < 220),  # a loop that is left and entered again
        ("x", lambda n: n == 0),
        ("x", lambda _: False),  # a method reads it, which waits for something else first
    ],
)
async def test_losses_on_purpose(
    graph: Graph, caplog: pytest.LogCaptureFixture, name: str, read: Callable[[int], bool]
) -> None:
    """Nothing is told."""
    node = Reader()
    await graph.start(node)
    await flood(graph, getattr(node, name), f"/{name}", read)
    assert getattr(node, name).dropped >= 100
    assert caplog.messages == []


async def test_keep_all_keeps_up_to_its_bound(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """KEEP_ALL is not without end: beyond its bound messages are lost and counted."""
    monkeypatch.setattr(inbox_module, "KEEP_ALL_BOUND", 50)
    node = Node("n")
    subscribed = node.create_subscription(Int32, "x", None, Qos(depth=1, history=History.KEEP_ALL))
    await graph.start(node)
    publisher = graph.publisher(Int32, "/x")
    for n in range(60):
        publisher.publish(Int32(data=n))
    await graph.settle()

    assert (subscribed.received, subscribed.dropped) == (60, 10)


@pytest.mark.parametrize(("depth", "text"), [(10, "most messages are lost"), (200, "its queue was full")])
async def test_a_handler_that_never_returns_is_told(
    graph: Graph, caplog: pytest.LogCaptureFixture, depth: int, text: str
) -> None:
    """Once, even after many messages; its queue is never emptied again."""
    node, gate = Node("n"), asyncio.Event()
    gate.set()

    async def stuck(message: Int32) -> None:
        await gate.wait()

    node.create_subscription(Int32, "x", stuck, depth)
    await graph.start(node)
    publisher = graph.publisher(Int32, "/x")
    for n in range(1000):
        publisher.publish(Int32(data=n))
        await graph.settle()
        if n == 299:
            assert not caplog.records
            gate.clear()

    [told] = [r.getMessage() for r in caplog.records if text in r.getMessage()]
    assert "graphflow waits says where it is now" in told


async def test_a_deep_queue_that_is_full_is_told(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Once, when its bytes are too many: those of messages from elsewhere, and of the same process."""
    monkeypatch.setattr(inbox_module, "BYTES_BOUND", 10_000)
    node, gate = Node("n"), asyncio.Event()

    async def slow(message: String) -> None:
        await gate.wait()

    subscribed = node.create_subscription(String, "x", slow, Qos(history=History.KEEP_ALL))
    own = node.create_publisher(String, "x")
    await graph.start(node)
    publisher = graph.publisher(String, "/x")
    for _ in range(20):
        publisher.publish(String(data="x" * 900))
        own.publish(String(data="x" * 900))
        await graph.settle()
    waiting = subscribed.statistics()["waiting"]
    gate.set()
    await graph.settle()

    assert waiting <= 11
    assert subscribed.received == 40
    assert subscribed.dropped == 40 - waiting - 1
    [record] = [r for r in caplog.records if "its queue was full" in r.getMessage()]
    assert "it holds 10000 messages and 256 MB" in record.getMessage()


def raw_sender(graph: Graph, receiver: TopicSubscription[Any]) -> Callable[[bytes, bytes], None]:
    """Something that puts any bytes on a subscription's key."""
    assert receiver.entity is not None
    session = graph.network.session(asyncio.get_running_loop())
    sender = session.open_sender(receiver.entity.data_key, Qos())
    return lambda payload, beside: sender.put(payload, attachment=beside)


@pytest.mark.parametrize("iterated", [False, True])
async def test_malformed_payloads_are_dropped(graph: Graph, caplog: pytest.LogCaptureFixture, iterated: bool) -> None:
    """Invalid bytes are counted and logged once, and the next message is delivered."""
    node, log = Node("n"), Log()
    subscribed = node.create_subscription(String, "x", None if iterated else log)
    await graph.start(node)
    send = raw_sender(graph, subscribed)
    for payload in (b"", b"\0\1\0\0\xff\xff\xff\xff", b"\0\1\0\0", String(data="good").to_bytes()):
        send(payload, b"")
    if iterated:
        log(await anext(aiter(subscribed)))
    await graph.settle()

    assert log == [String(data="good")]
    assert subscribed.malformed == 3
    [record] = caplog.records
    assert record.getMessage().startswith("/x: dropped a malformed message (1 so far): ")


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("lifespan_ns", [INFINITE_NS, 1_000_000])
@pytest.mark.parametrize("takes_info", [False, True])
async def test_the_short_way_of_a_message_is_the_general_one(
    graph: Graph, seed: int, lifespan_ns: int, takes_info: bool
) -> None:
    """Whatever arrives: gaps, repetitions, strangers, old messages, foreign attachments, other payloads."""
    random, now = Random(seed), graph.clock.time_ns()
    logs: list[list[Any]] = [[], []]
    node = Node("n")
    qos = Qos(10, lifespan_ns=lifespan_ns)
    short, general = (
        TopicSubscription(
            core_of(node), String, "/x", qos, lambda *given, log=log: log.append(given), takes_info=takes_info
        )
        for log in logs
    )
    await graph.start(node)
    for each in (short, general):
        each._read = lambda arrival: arrival
    gids = [bytes([i]) * 16 for i in range(3)]
    for each in (short, general):
        each._sources[gids[0]] = Source(lifespan_ns)
    invoke = short._invoker()
    sequences = dict.fromkeys(gids, 0)
    for _ in range(60):
        gid = random.choice(gids)
        sequences[gid] = max(0, sequences[gid] + random.choice([1, 1, 1, 1, 0, 3, -2]))
        whole = attachment.pack(sequences[gid], now - random.choice([0, 0, 10_000_000]), gid)
        beside = random.choice([whole] * 8 + [whole[:20], whole.replace(b"\x10", b"\x11"), None])
        payload = String(data=str(_)).to_bytes()
        arrival = (random.choice([payload] * 6 + [payload[:6]]), beside)
        assert invoke(arrival) == general._invoke(arrival)
    assert logs[0] == logs[1]
    assert short.statistics() == general.statistics()
    known = [{gid: source.sequence for gid, source in each._sources.items()} for each in (short, general)]
    assert known[0] == known[1]


async def test_a_decode_error_of_the_handlers_own_is_an_error(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A DecodeError of the handler is not attributed to the sender."""
    node = Node("n")

    def unpack(message: String) -> None:
        Int32.from_bytes(message.data.encode())

    subscribed = node.create_subscription(String, "x", unpack)
    await graph.start(node)
    for _ in range(2):
        graph.publisher(String, "/x").publish(String(data="?"))
        await graph.clock.advance(1.0)

    assert subscribed.malformed == 0
    assert [r.levelno for r in caplog.records] == [logging.ERROR] * 2


async def test_an_error_in_a_handler_is_logged_and_the_next_message_handled(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """The log has the handler's name and the traceback; the node goes on."""
    log = Log()

    class Fussy(Node):
        @subscription(Int32, "x")
        async def check(self, message: Int32) -> None:
            if message.data == 1:
                raise ValueError("I do not like 1")
            log(message.data)

    await graph.start(Fussy())
    publisher = graph.publisher(Int32, "/x")
    for n in range(3):
        publisher.publish(Int32(data=n))
    await graph.settle()

    assert log == [0, 2]
    [record] = caplog.records
    assert record.getMessage() == "check: ValueError: I do not like 1"
    assert record.name == "graphflow.node.fussy"
    assert record.exc_info is not None


async def test_a_closed_endpoint_is_gone(graph: Graph) -> None:
    """Closing withdraws it from the graph at once, and twice is harmless."""
    node, log = Node("n"), Log()
    await graph.start(node)
    publisher = node.create_publisher(String, "x")
    subscribed = node.create_subscription(String, "x", log)
    await graph.settle()
    assert publisher.get_subscription_count() == 1
    assert publisher.is_open
    subscribed.close()
    subscribed.close()
    await graph.settle()
    publisher.publish(String())
    await graph.settle()

    assert publisher.get_subscription_count() == 0
    assert log == []
    assert not subscribed.is_open
    publisher.close()
    with pytest.raises(ClosedError):
        publisher.publish(String())


async def test_a_handler_may_close_its_own_subscription(graph: Graph) -> None:
    """It receives no more messages."""
    node, log = Node("n"), Log()

    async def once(message: Int32) -> None:
        log(message.data)
        subscribed.close()

    subscribed = node.create_subscription(Int32, "x", once)
    await graph.start(node)
    for n in range(3):
        graph.publisher(Int32, "/x").publish(Int32(data=n))
    await graph.settle()

    assert log == [0]


async def test_other_types_on_a_topic_are_not_heard(graph: Graph) -> None:
    """A topic used with two types is two topics that share a name, and counts show it."""
    node, log = Node("n"), Log()
    subscribed = node.create_subscription(String, "x", log)
    await graph.start(node)
    publisher = graph.publisher(Int32, "/x")
    await graph.settle()
    publisher.publish(Int32())
    await graph.settle()

    assert log == []
    assert subscribed.get_publisher_count() == publisher.get_subscription_count() == 0


async def test_a_latecomer_gets_what_was_latched(graph: Graph) -> None:
    """With TRANSIENT_LOCAL on both sides, the last messages are kept for late subscriptions."""
    latched = Qos(depth=2, durability=Durability.TRANSIENT_LOCAL)
    node = Node("n")
    await graph.start(node)
    publisher = node.create_publisher(Int32, "map", latched)
    for n in range(3):
        publisher.publish(Int32(data=n))
    late = graph.tap(Int32, "/map", latched)
    fresh = graph.tap(Int32, "/map")
    await graph.settle()

    assert [m.data for m in late] == [1, 2]
    assert not fresh


async def test_reprs_tell_name_and_type(graph: Graph) -> None:
    """They are readable."""
    node = Speaker()

    assert repr(node.chatter) == "<TopicPublisher /chatter [std_msgs/msg/String]>"
    assert repr(node.heard) == "<TopicSubscription /chatter [std_msgs/msg/String]>"
    assert repr(node.create_client(Empty, "go")) == "<ServiceClient /go [std_srvs/srv/Empty]>"
    assert repr(node.create_timer(0.5, nothing)) == "<Timer nothing 0.5 s>"


async def test_an_iteration_leaves_the_loop_its_turns(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """A reader whose queue is full lets others run when its slice is over, here after every message."""
    monkeypatch.setattr(subscriptions, "SLICE", 0.0)
    node = Node("reader")
    heard = node.create_subscription(String, "chatter", None, 50)
    await graph.start(node)
    publisher = graph.publisher(String, "/chatter")
    for _ in range(50):
        publisher.publish(String())
    await graph.settle()
    taken: list[int] = []
    turns: list[int] = []

    async def read() -> None:
        async for _ in heard:
            taken.append(len(turns))

    reader = asyncio.ensure_future(read())
    while len(taken) < 50:
        turns.append(len(taken))
        await asyncio.sleep(0)
    turns.append(len(taken))
    reader.cancel()

    assert all(later - earlier <= 1 for earlier, later in itertools.pairwise(turns))


async def test_a_subscription_that_is_paused_leaves_out_what_comes(graph: Graph) -> None:
    """Including messages that arrive just before it resumes."""
    listener, heard = Node("listener"), Log()
    listening = listener.create_subscription(String, "chatter", lambda message: heard(message.data))
    await graph.start(listener)
    publisher = graph.publisher(String, "/chatter")
    await graph.settle()
    listening.pause("it is night")
    publisher.publish(String(data="night"))
    await graph.settle()
    publisher.publish(String(data="dawn"))
    listening.resume()
    publisher.publish(String(data="day"))
    await graph.settle()
    assert heard == ["day"]


async def test_messages_of_any_number_of_senders(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """All are heard, and only so many of their senders are remembered."""
    monkeypatch.setattr(subscriptions, "SOURCES_BOUND", 2)
    node, log = Node("n"), Log()
    listening = node.create_subscription(String, "x", lambda message: log(message.data))
    await graph.start(node)
    for number in range(4):
        assert listening._is_fresh(1, 0, bytes([number]) * 16)
    assert len(listening._sources) == 2


async def test_a_reading_after_the_nodes_end(graph: Graph) -> None:
    """The end of the iteration says why nothing can be read."""
    node = Node("reader")
    heard = node.create_subscription(String, "chatter", None, 10)
    await graph.start(node)
    await graph.stop(node)
    with pytest.raises(StopAsyncIteration, match="/chatter is closed: read it while its node runs"):
        await anext(heard)
