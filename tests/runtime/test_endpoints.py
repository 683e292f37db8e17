"""Publishers, subscriptions, services, clients and timers at work."""

from __future__ import annotations

import asyncio
import logging
import re
import threading
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

from graphflow import (
    CallTimeout,
    DecodeError,
    EncodeError,
    Group,
    Node,
    Param,
    ParameterError,
    Publisher,
    Qos,
    RemoteError,
    ServerLost,
    ServiceUnavailable,
    Subscription,
    TimerInfo,
    service,
    subscription,
    timer,
)
from graphflow.errors import ClosedError
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.rcl_interfaces.srv import ListParameters
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.std_srvs.srv import Empty, Trigger
from graphflow.qos import Durability, History
from graphflow.runtime import endpoints
from graphflow.runtime.endpoints import ServiceClient, TopicSubscription
from graphflow.testing import Graph
from graphflow.transport.base import Answer, Inbox
from graphflow.wire import attachment
from graphflow.wire.liveliness import Kind


async def nothing() -> None:
    """Do nothing."""


class Log(list[Any]):
    """What a handler was called with."""

    def __call__(self, item: Any) -> None:
        self.append(item)


class Speaker(Node):
    """Holds a publisher and listens by iterating."""

    chatter = Publisher(String, "chatter")
    heard = Subscription(String, "chatter", 3)


# topics


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
    """A sender that says nothing about itself is anonymous, not silent."""
    node = Speaker()
    await graph.start(node)
    raw_sender(graph, node.heard)(String(data="x").to_bytes(), b"")

    message, info = await node.heard.next_with_info()

    assert message.data == "x"
    assert info == (0, 0, bytes(16))


async def test_only_one_of_callback_and_iteration(graph: Graph) -> None:
    """A subscription with a callback cannot be iterated too, and says what to do."""
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
    """What arrives while a run is under way waits in the queue, which is as deep as asked for."""
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


async def test_keep_all_keeps_up_to_its_bound(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """KEEP_ALL is not without end: beyond its bound messages are lost and counted."""
    monkeypatch.setattr(endpoints, "KEEP_ALL_BOUND", 50)
    node = Node("n")
    subscribed = node.create_subscription(Int32, "x", None, Qos(depth=1, history=History.KEEP_ALL))
    await graph.start(node)
    publisher = graph.publisher(Int32, "/x")
    for n in range(60):
        publisher.publish(Int32(data=n))
    await graph.settle()

    assert (subscribed.received, subscribed.dropped) == (60, 10)


def raw_sender(graph: Graph, receiver: TopicSubscription[Any]) -> Callable[[bytes, bytes], None]:
    """Something that puts any bytes on a subscription's key."""
    assert receiver.entity is not None
    session = graph.network.session(asyncio.get_running_loop())
    return session.open_sender(receiver.entity.data_key, Qos()).put


@pytest.mark.parametrize("iterated", [False, True])
async def test_malformed_payloads_are_dropped(graph: Graph, caplog: pytest.LogCaptureFixture, iterated: bool) -> None:
    """Bytes that are no message of the type are counted, said once, and do not disturb the next message."""
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


async def test_a_decode_error_of_the_handlers_own_is_an_error(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """What the handler failed to decode is not blamed on the sender of its message."""
    node = Node("n")

    def unpack(message: String) -> None:
        Int32.from_bytes(message.data.encode())

    subscribed = node.create_subscription(String, "x", unpack)
    await graph.start(node)
    for _ in range(2):
        graph.publisher(String, "/x").publish(String(data="?"))
    await graph.settle()

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


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (Int32(), r"/chatter carries std_msgs/msg/String, not std_msgs\.msg\.Int32"),
        ("hello", "/chatter carries std_msgs/msg/String, not 'hello'"),
        (None, "/chatter carries std_msgs/msg/String, not None"),
    ],
)
async def test_publishing_another_type_is_an_error(graph: Graph, message: Any, text: str) -> None:
    """EncodeError names the topic, its type and what was given; nothing is sent."""
    node = Speaker()
    await graph.start(node)

    with pytest.raises(EncodeError, match=text):
        node.chatter.publish(message)

    assert node.chatter.published == 0


async def test_publishing_a_wrong_field_is_an_error(graph: Graph) -> None:
    """EncodeError names the field; nothing is sent, and the next good message is."""
    node = Speaker()
    await graph.start(node)
    wrong = String()
    wrong.data = 5  # type: ignore[assignment]

    with pytest.raises(EncodeError, match="data"):
        node.chatter.publish(wrong)
    node.chatter.publish(String(data="good"))
    await graph.settle()

    assert node.chatter.published == 1
    assert node.heard.received == 1


async def test_publishing_needs_a_running_node(graph: Graph) -> None:
    """Before its start and after its stop a node cannot publish, says so, and counts nothing."""
    node = Speaker()
    with pytest.raises(ClosedError, match="/chatter: node /speaker is not running; use this from its handlers"):
        node.chatter.publish(String())
    await graph.start(node)
    node.chatter.publish(String())
    await graph.stop(node)
    with pytest.raises(ClosedError, match="not running"):
        node.chatter.publish(String())

    assert node.chatter.published == 1
    with pytest.raises(ClosedError):
        node.chatter.get_subscription_count()


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
    """It hears nothing more."""
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
    """With transient-local durability on both sides the last messages wait for whoever comes."""
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
    """What is printed can be read."""
    node = Speaker()

    assert repr(node.chatter) == "<TopicPublisher /chatter [std_msgs/msg/String]>"
    assert repr(node.heard) == "<TopicSubscription /chatter [std_msgs/msg/String]>"
    assert repr(node.create_client(Empty, "go")) == "<ServiceClient /go [std_srvs/srv/Empty]>"
    assert repr(node.create_timer(0.5, nothing)) == "<Timer nothing 0.5 s>"


# services


class Adder(Node):
    """Serves in every way there is."""

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        await asyncio.sleep(0)
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(AddTwoInts, "add_plain")
    def add_plain(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(AddTwoInts, "add_in_thread", thread=True)
    def add_in_thread(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        assert threading.current_thread() is not threading.main_thread()
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(Empty, "go")
    async def go(self, request: Empty.Request) -> None:
        """Answer an empty response with nothing."""

    @service(AddTwoInts, "raises")
    async def raises(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        raise ValueError(f"{request.a} is too much")

    @service(AddTwoInts, "raises_plainly")
    def raises_plainly(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        raise KeyError("lost")

    @service(AddTwoInts, "wrong_type")
    async def wrong_type(self, request: AddTwoInts.Request) -> Any:
        return Trigger.Response()

    @service(AddTwoInts, "returns_nothing")
    async def returns_nothing(self, request: AddTwoInts.Request) -> Any:
        return None

    @service(AddTwoInts, "wrong_field")
    async def wrong_field(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        response = AddTwoInts.Response()
        response.sum = 2**70
        return response

    @service(AddTwoInts, "cancelled_inside")
    async def cancelled_inside(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        inner = asyncio.ensure_future(asyncio.Event().wait())
        inner.cancel()
        await inner
        return AddTwoInts.Response()


@pytest.mark.parametrize("name", ["add", "add_plain", "add_in_thread"])
async def test_a_service_answers(graph: Graph, name: str) -> None:
    """A handler may be a coroutine, a function, or a function in a thread."""
    await graph.start(Adder())

    response = await graph.call(AddTwoInts, f"/{name}", AddTwoInts.Request(a=2, b=40))

    assert response == AddTwoInts.Response(sum=42)


async def test_an_empty_response_may_be_none(graph: Graph) -> None:
    """A handler with nothing to say need not say it."""
    await graph.start(Adder())

    assert await graph.call(Empty, "/go", Empty.Request()) == Empty.Response()


@pytest.mark.parametrize(
    ("name", "type_", "text"),
    [
        ("raises", "ValueError", "^7 is too much$"),
        ("raises_plainly", "KeyError", "^'lost'$"),
        ("wrong_type", "TypeError", r"the handler of /wrong_type returned std_srvs.*not .*AddTwoInts.*Response"),
        ("returns_nothing", "TypeError", "the handler of /returns_nothing returned None, not .*AddTwoInts.*Response"),
        ("wrong_field", "EncodeError", "sum"),
        ("cancelled_inside", "CancelledError", ""),
    ],
)
async def test_a_failing_service_tells_its_caller(
    graph: Graph, caplog: pytest.LogCaptureFixture, name: str, type_: str, text: str
) -> None:
    """The caller gets the remote type and text, the server logs what is an error, and goes on to the next request."""
    await graph.start(Adder())

    for _ in range(2):
        with pytest.raises(RemoteError) as caught:
            await graph.call(AddTwoInts, f"/{name}", AddTwoInts.Request(a=7))
        assert caught.value.type == type_
        assert re.search(text, caught.value.message)

    assert [r.name for r in caplog.records] == ["graphflow.node.adder"] * (0 if type_ == "CancelledError" else 2)


class SlowAdder(Node):
    """Answers when told to."""

    def __init__(self) -> None:
        super().__init__()
        self.gate = asyncio.Event()
        self.asked = Log()

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        self.asked(request.a)
        await self.gate.wait()
        return AddTwoInts.Response(sum=request.a + request.b)


async def client_of(graph: Graph, name: str = "add") -> ServiceClient[AddTwoInts.Request, AddTwoInts.Response]:
    """A client in a node of its own."""
    node = Node("caller")
    client = node.create_client(AddTwoInts, name)
    await graph.start(node)
    return client


async def begun(graph: Graph, call: Coroutine[Any, Any, AddTwoInts.Response]) -> asyncio.Task[AddTwoInts.Response]:
    """A call under way."""
    task = asyncio.create_task(call)
    await graph.settle()
    return task


async def test_requests_are_answered_in_the_order_of_arrival(graph: Graph) -> None:
    """One at a time, as the handler queues behind itself; every caller gets its own answer."""
    server = SlowAdder()
    await graph.start(server)
    client, other = await client_of(graph), graph.call
    calls = [await begun(graph, client.call(AddTwoInts.Request(a=n, b=1))) for n in (1, 2)]
    calls.append(await begun(graph, other(AddTwoInts, "/add", AddTwoInts.Request(a=3, b=1))))
    assert server.asked == [1]

    server.gate.set()
    await graph.settle()

    assert server.asked == [1, 2, 3]
    assert [c.result().sum for c in calls] == [2, 3, 4]


async def test_a_service_nobody_offers(graph: Graph) -> None:
    """The call waits a moment for discovery, and its error names the nearest service there is."""
    await graph.start(Adder())
    client = await client_of(graph, "ad")
    assert not client.service_is_ready()
    call = await begun(graph, client.call(AddTwoInts.Request()))

    await graph.clock.advance(0.9)
    assert not call.done()
    await graph.clock.advance(0.2)

    with pytest.raises(ServiceUnavailable) as caught:
        await call
    assert str(caught.value) == (
        "nobody offers the service /ad [example_interfaces/srv/AddTwoInts]; did you mean '/add'?"
    )


async def test_a_service_of_another_type(graph: Graph) -> None:
    """The error tells which type the service has."""
    await graph.start(Adder())
    call = asyncio.create_task(graph.call(Trigger, "/add", Trigger.Request()))

    await graph.clock.advance(1.0)

    with pytest.raises(ServiceUnavailable) as caught:
        await call
    assert str(caught.value) == "service /add is a example_interfaces/srv/AddTwoInts, not a std_srvs/srv/Trigger"


async def test_a_call_does_not_wait_longer_for_discovery_than_for_its_answer(graph: Graph) -> None:
    """A timeout shorter than the grace holds."""
    client = await client_of(graph)
    call = await begun(graph, client.call(AddTwoInts.Request(), timeout=0.25))

    await graph.clock.advance(0.25)

    with pytest.raises(ServiceUnavailable):
        await call


async def test_a_server_that_comes_in_time(graph: Graph) -> None:
    """A call made a moment too early finds its server."""
    client = await client_of(graph)
    call = await begun(graph, client.call(AddTwoInts.Request(a=1, b=2)))
    await graph.clock.advance(0.5)

    await graph.start(Adder())

    assert (await call).sum == 3


async def test_the_deadline_passes(graph: Graph) -> None:
    """CallTimeout comes when the clock has reached the deadline and not before; it is a TimeoutError too."""
    await graph.start(SlowAdder())
    client = await client_of(graph)
    call = await begun(graph, client.call(AddTwoInts.Request(), timeout=2.5))
    default = await begun(graph, client.call(AddTwoInts.Request()))
    patient = await begun(graph, client.call(AddTwoInts.Request(), timeout=None))

    await graph.clock.advance(2.4)
    assert not call.done()
    await graph.clock.advance(0.1)
    with pytest.raises(CallTimeout, match=r"^/add did not answer within 2\.5 s$") as caught:
        await call
    assert isinstance(caught.value, TimeoutError)

    await graph.clock.advance(7.4)
    assert not default.done()
    await graph.clock.advance(0.1)
    with pytest.raises(CallTimeout, match="within 10 s"):
        await default

    await graph.clock.advance(1e6)
    assert not patient.done()
    patient.cancel()


@pytest.mark.parametrize("ends", ["by its deadline", "by cancellation"])
async def test_a_late_reply_is_ignored(graph: Graph, ends: str) -> None:
    """An answer to a call that is over reaches nobody, least of all the next call."""
    server = SlowAdder()
    await graph.start(server)
    client = await client_of(graph)
    first = await begun(graph, client.call(AddTwoInts.Request(a=1), timeout=1.0))
    if ends == "by its deadline":
        await graph.clock.advance(1.0)
        with pytest.raises(CallTimeout):
            await first
    else:
        first.cancel()
        with pytest.raises(asyncio.CancelledError):
            await first
    second = await begun(graph, client.call(AddTwoInts.Request(a=2)))
    server.gate.set()

    assert (await second).sum == 2
    assert server.asked == [1, 2]


async def test_a_call_that_is_over_is_given_up(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """The network need not keep it: one that was cancelled or too late; not one that was answered."""
    given_up: list[int] = []
    server = SlowAdder()
    await graph.start(server)
    client = await client_of(graph)
    caller = client._caller
    assert caller is not None
    really_call = caller.call

    def call(payload: bytes, beside: bytes, answered: Callable[[Answer | None], None]) -> Callable[[], None]:
        give_up = really_call(payload, beside, answered)

        def note() -> None:
            given_up.append(attachment.unpack(beside).sequence)
            give_up()

        return note

    monkeypatch.setattr(caller, "call", call)
    late = await begun(graph, client.call(AddTwoInts.Request(), timeout=1.0))
    cancelled = await begun(graph, client.call(AddTwoInts.Request()))
    answered = await begun(graph, client.call(AddTwoInts.Request()))
    cancelled.cancel()
    await graph.clock.advance(1.0)
    server.gate.set()
    await answered

    assert given_up == [2, 1]
    with pytest.raises(CallTimeout):
        await late


async def test_the_server_stops_during_the_call(graph: Graph) -> None:
    """The calls that are being answered and those still queued all end with ServerLost, at once."""
    server = SlowAdder()
    await graph.start(server)
    client = await client_of(graph)
    calls = [await begun(graph, client.call(AddTwoInts.Request(a=n))) for n in range(3)]

    await graph.stop(server)

    assert server.asked == [0]
    for call in calls:
        assert call.done()
        with pytest.raises(ServerLost, match="/add"):
            await call


async def test_a_request_during_the_servers_cleanup(graph: Graph) -> None:
    """A server that is stopping answers no more, and its callers need not wait for their deadline."""
    cleaned = asyncio.Event()

    class Tidy(Node):
        @service(AddTwoInts, "add")
        async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
            try:
                await asyncio.Event().wait()
            finally:
                await cleaned.wait()
            return AddTwoInts.Response()

    server = Tidy()
    await graph.start(server)
    client = await client_of(graph)
    first = await begun(graph, client.call(AddTwoInts.Request()))
    stopping = asyncio.create_task(server.stop())
    await graph.settle()
    second = await begun(graph, client.call(AddTwoInts.Request()))
    cleaned.set()
    await stopping
    await graph.settle()

    for call in (first, second):
        assert call.done()
        with pytest.raises(ServerLost):
            await call


async def test_a_server_that_vanishes(graph: Graph) -> None:
    """A request that ends without an answer, as when the server's process dies, is a lost server."""
    client = await client_of(graph)
    server = RawServer(graph, client)
    call = await begun(graph, client.call(AddTwoInts.Request()))

    server.requests.clear()
    await graph.settle()

    with pytest.raises(ServerLost, match="the server of /add went away before it answered"):
        await call


class RawServer:
    """A server that answers with any bytes."""

    def __init__(self, graph: Graph, client: ServiceClient[Any, Any]) -> None:
        assert client.entity is not None
        session = graph.network.session(asyncio.get_running_loop())
        inbox = Inbox(session.bell, 100, lambda: None)
        self.requests = inbox.items
        self._declared = [
            session.open_server(client.entity.data_key, inbox),
            session.announce(client.entity._replace(kind=Kind.SERVICE, zid=session.zid).token),
        ]

    def beside(self) -> attachment.Attachment:
        return attachment.unpack(self.requests[0].attachment)


async def test_answers_that_do_not_fit(graph: Graph) -> None:
    """A malformed response is a DecodeError; one to another question counts as none; any error text is passed on."""
    client = await client_of(graph)
    server = RawServer(graph, client)
    await graph.settle()

    call = await begun(graph, client.call(AddTwoInts.Request()))
    beside = server.beside()
    server.requests.popleft().reply(b"\0\1\0\0", attachment.pack(beside.sequence, 0, beside.gid))
    with pytest.raises(DecodeError):
        await call

    for wrong in (attachment.pack(99, 0, bytes(16)), b"too short"):
        call = await begun(graph, client.call(AddTwoInts.Request()))
        server.requests.popleft().reply(AddTwoInts.Response(sum=1).to_bytes(), wrong)
        with pytest.raises(ServerLost):
            await call

    call = await begun(graph, client.call(AddTwoInts.Request()))
    server.requests.popleft().reply_error(b"\xffnot JSON")
    with pytest.raises(RemoteError, match=r"Error: .not JSON"):
        await call


async def test_a_request_carries_what_rmw_expects(graph: Graph) -> None:
    """Sequence numbers count from one, and the GID is the client's own."""
    client = await client_of(graph)
    server = RawServer(graph, client)
    calls = [await begun(graph, client.call(AddTwoInts.Request(a=n))) for n in (5, 6)]
    requests = list(server.requests)

    assert client.entity is not None
    besides = [attachment.unpack(r.attachment) for r in requests]
    assert [(b.sequence, b.gid) for b in besides] == [(1, client.entity.gid), (2, client.entity.gid)]
    assert [AddTwoInts.Request.from_bytes(r.payload).a for r in requests] == [5, 6]
    for call in calls:
        call.cancel()


async def test_a_malformed_request_is_refused(graph: Graph) -> None:
    """The server answers it with the error, and goes on."""
    await graph.start(Adder())
    client = await client_of(graph)
    assert client.entity is not None
    session = graph.network.session(asyncio.get_running_loop())
    answers: list[Answer | None] = []
    caller = session.open_caller(client.entity.data_key)
    caller.call(b"\0\1", attachment.pack(1, 0, bytes(16)), answers.append)
    caller.call(AddTwoInts.Request().to_bytes(), b"no attachment", answers.append)
    await graph.settle()

    errors = [a for a in answers if a is not None]
    assert [a.is_error for a in errors] == [True, True]
    assert all(b"DecodeError" in a.payload for a in errors)
    assert (await client.call(AddTwoInts.Request(a=1, b=1))).sum == 2


async def test_a_call_with_a_wrong_request(graph: Graph) -> None:
    """EncodeError names the service and what it takes, or the field; nothing is sent."""
    server = SlowAdder()
    await graph.start(server)
    client = await client_of(graph)

    with pytest.raises(EncodeError, match=r"/add takes AddTwoInts.*Request, not example_interfaces.*Response"):
        await client.call(AddTwoInts.Response())  # type: ignore[arg-type]
    wrong = AddTwoInts.Request()
    wrong.a = "one"  # type: ignore[assignment]
    with pytest.raises(EncodeError, match="a"):
        await client.call(wrong)
    await graph.settle()

    assert server.asked == []


async def test_a_call_needs_a_running_node(graph: Graph) -> None:
    """Before the start there is nothing to call with."""
    client = Node("n").create_client(AddTwoInts, "add")

    with pytest.raises(ClosedError, match="not running"):
        await client.call(AddTwoInts.Request())


async def test_waiting_for_a_server(graph: Graph) -> None:
    """`wait_ready` ends when the server is there, and at once when it is there already."""
    client = await client_of(graph)
    waiting = asyncio.create_task(client.wait_ready())
    await graph.clock.advance(1000.0)
    assert not waiting.done()
    server = Adder()
    await graph.start(server)

    await waiting
    await client.wait_ready(timeout=1.0)
    assert client.service_is_ready()
    await graph.stop(server)
    assert not client.service_is_ready()


async def test_waiting_for_a_server_in_vain(graph: Graph) -> None:
    """With a timeout, ServiceUnavailable comes when it has passed."""
    client = await client_of(graph)
    waiting = asyncio.create_task(client.wait_ready(timeout=5.0))
    await graph.clock.advance(4.9)
    assert not waiting.done()

    await graph.clock.advance(0.1)

    with pytest.raises(ServiceUnavailable, match="nobody offers the service /add"):
        await waiting


async def test_waiting_with_a_client_that_is_closed(graph: Graph) -> None:
    """The wait ends with ClosedError, and others who watch the graph hear of the change all the same."""
    client = await client_of(graph)
    waiting = asyncio.create_task(client.wait_ready())
    await graph.settle()
    changes = Log()
    client.node.context.on_change(changes)
    client.close()
    await graph.settle()
    changes.clear()

    await graph.start(Adder())

    assert changes
    with pytest.raises(ClosedError):
        await waiting


# timers


class Ticker(Node):
    """Notes when it ticks, in tenths of a second since the start."""

    rate = Param(10.0, gt=0.0)

    def __init__(self, takes: float = 0.0, **params: Any) -> None:
        super().__init__(**params)
        self.takes = takes
        self.ticks: list[TimerInfo] = []
        self.running = 0

    @timer(hz=rate)
    async def tick(self, info: TimerInfo) -> None:
        assert self.running == 0
        self.running += 1
        self.ticks.append(info)
        if self.takes:
            await self.clock.sleep(self.takes)
        self.running -= 1

    @property
    def times(self) -> list[int]:
        return [info.expected_ns // 100_000_000 for info in self.ticks]


async def test_a_timer_ticks_once_a_period(graph: Graph) -> None:
    """First one period after the start, and never early."""
    node = Ticker()
    await graph.start(node)
    await graph.clock.advance(0.09)
    assert node.ticks == []

    await graph.clock.advance(0.5)

    assert node.times == [1, 2, 3, 4, 5]
    assert all(info.actual_ns == info.expected_ns and info.skipped == 0 for info in node.ticks)


async def test_a_slow_run_skips_periods_and_keeps_the_phase(graph: Graph) -> None:
    """With runs of 0.25 s every third period of 0.1 s has one, and the others are counted."""
    node = Ticker(takes=0.25)
    await graph.start(node)

    await graph.clock.advance(1.05)

    assert node.times == [1, 4, 7, 10]
    assert [info.skipped for info in node.ticks] == [0, 2, 2, 2]


async def test_a_blocked_loop_skips_periods_and_keeps_the_phase(graph: Graph) -> None:
    """A run that comes late says so, missed ones are not made up for, and the next is back in phase."""
    node, infos = Node("n"), Log()
    ticking = node.create_timer(0.1, infos, takes_info=True)
    await graph.start(node)
    await graph.clock.advance(0.1)
    graph.clock._elapsed_ns += 350_000_000  # as if something had computed for so long
    await graph.clock.advance(0.25)

    ms = 1_000_000
    assert infos == [
        TimerInfo(100 * ms, 100 * ms, 0),
        TimerInfo(200 * ms, 450 * ms, 2),
        TimerInfo(500 * ms, 500 * ms, 0),
        TimerInfo(600 * ms, 600 * ms, 0),
        TimerInfo(700 * ms, 700 * ms, 0),
    ]
    assert ticking.skipped == 2


async def test_a_timer_that_waits_for_its_group_is_not_doubled(graph: Graph) -> None:
    """While its group is busy one run waits and the rest are skipped."""
    gate, log = asyncio.Event(), Log()

    class Busy(Node):
        group = Group(1)

        @subscription(String, "x", group=group)
        async def hold(self, _: String) -> None:
            await gate.wait()

        @timer(0.1, group=group)
        async def tick(self, info: TimerInfo) -> None:
            log((info.expected_ns // 100_000_000, info.skipped))

    await graph.start(Busy())
    graph.publisher(String, "/x").publish(String())
    await graph.clock.advance(0.55)
    assert log == []
    gate.set()
    await graph.clock.advance(0.2)

    assert log == [(1, 0), (6, 4), (7, 0)]


async def test_a_changed_period_holds_from_then_on(graph: Graph) -> None:
    """The next run is one new period after the change."""
    node = Ticker()
    await graph.start(node)
    await graph.clock.advance(0.15)

    node.rate = 2.0
    await graph.clock.advance(1.2)

    assert [info.expected_ns / 1e9 for info in node.ticks] == [0.1, 0.65, 1.15]


async def test_another_parameter_leaves_the_phase_alone(graph: Graph) -> None:
    """Only what the timer reads its rate from re-arms it."""

    class Two(Ticker):
        other = Param(1.0)

    node = Two()
    await graph.start(node)
    await graph.clock.advance(0.15)
    node.other = 2.0
    await graph.clock.advance(0.1)

    assert node.times == [1, 2]


async def test_a_rate_that_is_none_is_refused(graph: Graph) -> None:
    """A parameter without limits that sets a timer's rate cannot be set to what no timer can do; the old one stands."""

    class Loose(Node):
        rate = Param(10.0)
        ticks = 0

        @timer(hz=rate)
        async def tick(self) -> None:
            self.ticks += 1

    node = Loose()
    await graph.start(node)
    for wrong in (0.0, -1.0, float("inf")):
        with pytest.raises(ParameterError, match=r"'rate' .*must be a positive number"):
            node.rate = wrong
    await graph.clock.advance(1.0)

    assert node.rate == 10.0
    assert node.ticks == 10
    with pytest.raises(ParameterError, match=r"'rate' .*must be a positive number"):
        Loose(rate=0.0)


@pytest.mark.parametrize("period", [0.0, -1.0, float("nan"), float("inf")])
async def test_a_period_must_be_positive(graph: Graph, period: float) -> None:
    """A timer that would always be due is refused, when it is made and when it is changed."""
    node = Node("n")
    with pytest.raises(ValueError, match=r"period must be .*positive"):
        node.create_timer(period, nothing)
    ticking = node.create_timer(1.0, nothing)
    with pytest.raises(ValueError, match=r"period must be .*positive"):
        ticking.period = period

    assert ticking.period == 1.0


async def test_a_timer_can_be_stopped_and_begun_again(graph: Graph) -> None:
    """`cancel` ends its runs, `reset` begins one period from then."""
    node, log = Node("n"), Log()
    ticking = node.create_timer(0.1, lambda: log(graph.clock.monotonic_ns() // 1_000_000))
    await graph.start(node)
    await graph.clock.advance(0.15)
    ticking.cancel()
    await graph.clock.advance(1.0)
    ticking.reset()
    await graph.clock.advance(0.2)
    ticking.close()
    ticking.close()
    await graph.clock.advance(1.0)

    assert log == [100, 1250, 1350]


async def test_an_error_in_a_timer_is_logged_and_the_next_run_comes(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """The node goes on."""
    node = Node("n")

    async def wrong() -> None:
        raise ValueError("every time")

    node.create_timer(0.1, wrong)
    await graph.start(node)
    await graph.clock.advance(0.3)

    assert [r.getMessage() for r in caplog.records] == ["wrong: ValueError: every time"] * 3


async def test_a_timer_may_run_in_a_thread(graph: Graph) -> None:
    """A blocking body leaves the loop free."""
    node, ticked = Node("n"), asyncio.Event()
    loop = asyncio.get_running_loop()
    threads: list[bool] = []

    def work() -> None:
        threads.append(threading.current_thread() is threading.main_thread())
        loop.call_soon_threadsafe(ticked.set)

    node.create_timer(0.1, work, thread=True)
    await graph.start(node)
    await graph.clock.advance(0.1)
    await ticked.wait()

    assert threads == [False]


@pytest.mark.parametrize("kind", ["subscription", "service", "timer"])
async def test_a_coroutine_cannot_run_in_a_thread(graph: Graph, kind: str) -> None:
    """`thread=True` with an `async def` is refused where it is written: its body would never run."""
    node = Node("n")

    async def handler(_: object = None) -> None:
        """Do nothing."""

    make: dict[str, Callable[[], object]] = {
        "subscription": lambda: node.create_subscription(String, "x", handler, thread=True),
        "service": lambda: node.create_service(Empty, "x", handler, thread=True),
        "timer": lambda: node.create_timer(1.0, handler, thread=True),
    }
    with pytest.raises(ValueError, match="thread=True is for `def`"):
        make[kind]()


# groups


async def test_each_group_is_one_group(graph: Graph) -> None:
    """Groups made in passing are told apart, also when one takes the place of another in memory."""
    node, gate = Node("n"), asyncio.Event()
    running: list[int] = []

    def make(n: int) -> Callable[[String], Any]:
        async def handler(_: String) -> None:
            running.append(n)
            await gate.wait()

        return handler

    for n in range(8):
        node.create_subscription(String, "x", make(n), group=Group(1))
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.settle()

    assert sorted(running) == list(range(8))
    gate.set()


@pytest.mark.parametrize(("limit", "together"), [(1, 1), (2, 2), (None, 4)])
async def test_a_declared_group_holds_for_its_node(graph: Graph, limit: int | None, together: int) -> None:
    """Handlers of one group exclude each other as far as its limit says, in each node for itself."""
    peak: dict[str, int] = {}
    gate = asyncio.Event()

    class Crowd(Node):
        group = Group(limit)

        async def enter(self) -> None:
            peak[self.name] = peak.get(self.name, 0) + 1
            await gate.wait()

        @subscription(String, "x", group=group)
        async def first(self, _: String) -> None:
            await self.enter()

        @subscription(String, "x", group=group)
        async def second(self, _: String) -> None:
            await self.enter()

    await graph.start(Crowd("one"), Crowd("two"))
    for _ in range(2):
        graph.publisher(String, "/x").publish(String())
    await graph.settle()

    assert peak == {"one": together, "two": together}
    gate.set()


async def test_the_default_group_of_a_class(graph: Graph) -> None:
    """`default_group = Group(1)` gives rclpy's way back: nothing of the node runs beside anything else."""
    log, gate = Log(), asyncio.Event()

    class Classic(Node):
        default_group = Group(1)

        @subscription(String, "x")
        async def first(self, _: String) -> None:
            log("first")
            await gate.wait()

        @subscription(String, "x")
        async def second(self, _: String) -> None:
            log("second")

    node = Classic()
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.settle()
    assert log == ["first"]

    # Parameter services are never held up by a group of the user's.
    await graph.call(ListParameters, "/classic/list_parameters", ListParameters.Request())
    gate.set()
    await graph.settle()
    assert log == ["first", "second"]


async def test_a_call_to_oneself_in_one_group_waits_for_ever(graph: Graph) -> None:
    """A slot is held across every await, so a handler that calls its own group gets no answer in time."""

    class Narcissus(Node):
        default_group = Group(1)

        def __init__(self) -> None:
            super().__init__()
            self.client = self.create_client(AddTwoInts, "add")
            self.outcome = Log()

        @service(AddTwoInts, "add")
        async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
            return AddTwoInts.Response(sum=request.a + request.b)

        @subscription(String, "x")
        async def ask(self, _: String) -> None:
            try:
                self.outcome(await self.client.call(AddTwoInts.Request(), timeout=1.0))
            except CallTimeout:
                self.outcome("late")

    node = Narcissus()
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.clock.advance(1.0)

    assert node.outcome == ["late"]
