"""Services and their clients at work."""

from __future__ import annotations

import asyncio
import re
import threading
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

from graphflow import (
    CallTimeout,
    DecodeError,
    EncodeError,
    Node,
    RemoteError,
    ServerBusy,
    ServerLost,
    ServiceUnavailable,
    service,
)
from graphflow.errors import ClosedError
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_srvs.srv import Empty, Trigger
from graphflow.runtime import services
from graphflow.runtime.core import core_of
from graphflow.runtime.direct import ServerLines
from graphflow.runtime.service_client import ServiceClient
from graphflow.testing import Graph
from graphflow.transport.base import Answer, Inbox
from graphflow.wire import attachment
from graphflow.wire.liveliness import Kind
from tests.runtime.cast import Log


@pytest.fixture(autouse=True, params=["direct", "query"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """How calls travel: as between graphflow processes, or as with any other."""
    if request.param == "query":
        monkeypatch.setattr(ServerLines, "client_came", lambda self: None)
    return str(request.param)


async def nothing() -> None:
    """Do nothing."""


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

    await graph.clock.advance(1e3)
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


async def test_a_call_that_is_over_is_given_up(graph: Graph, monkeypatch: pytest.MonkeyPatch, way: str) -> None:
    """The network need not keep it: one that was cancelled or too late; not one that was answered."""
    given_up: list[int] = []
    server = SlowAdder()
    await graph.start(server)
    client = await client_of(graph)
    caller: Any = client._caller if way == "query" else client._line
    really_call = caller.call

    def call(*args: Any) -> Callable[[], None]:
        give_up = really_call(*args)

        def note() -> None:
            given_up.append(attachment.unpack(args[-2]).sequence)
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
    stopping = asyncio.create_task(core_of(server).stop())
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

    def beside(self) -> attachment.MessageInfo:
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
    caller = session.open_caller(client.entity.data_key, lambda: None)
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
    client.host.context.on_change(changes)
    client.close()
    await graph.settle()
    changes.clear()

    await graph.start(Adder())

    assert changes
    with pytest.raises(ClosedError):
        await waiting


class Gate(Node):
    """Answers nobody until it is opened."""

    def __init__(self) -> None:
        super().__init__()
        self.open = asyncio.Event()

    @service(Trigger, "pass")
    async def let_in(self, _: Trigger.Request) -> Trigger.Response:
        await self.open.wait()
        return Trigger.Response(success=True)


async def test_a_full_service_refuses_the_newest(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that wait already are answered in the end; the others are told at once."""
    monkeypatch.setattr(services, "REQUEST_QUEUE", 2)
    gate, caller = Gate(), Node("caller")
    client = caller.create_client(Trigger, "pass")
    await graph.start(gate, caller)
    calls = [asyncio.ensure_future(client.call(Trigger.Request())) for _ in range(5)]
    await graph.settle()

    gate.open.set()
    await graph.settle()
    results = await asyncio.gather(*calls, return_exceptions=True)

    assert [type(r) for r in results] == [Trigger.Response] * 3 + [ServerBusy] * 2
    assert "2 requests waiting" in str(results[-1])


async def test_a_closed_client_ends_its_calls(graph: Graph) -> None:
    """Nobody waits for an answer that has nowhere to go to."""
    caller = Node("caller")
    client = caller.create_client(Trigger, "pass")
    await graph.start(Gate(), caller)
    call = asyncio.ensure_future(client.call(Trigger.Request(), timeout=None))
    await graph.settle()

    client.close()

    with pytest.raises(ClosedError, match="the client of /pass was closed"):
        await call


async def test_ready_means_announced_and_reachable(graph: Graph) -> None:
    """A server whose token comes before its queryable, as foreign ones do, is not called too early."""
    asker = Node("asker")
    client = asker.create_client(AddTwoInts, "add")
    await graph.start(asker)
    session = graph.network.session(asker.context.loop)
    here = client.entity
    assert here is not None
    token = here._replace(zid=session.zid, kind=Kind.SERVICE, node="foreign").token
    ready = asyncio.ensure_future(client.wait_ready())
    call = asyncio.ensure_future(client.call(AddTwoInts.Request(a=1, b=2)))
    await graph.settle()
    session.announce(token)
    await graph.settle()
    assert not ready.done()
    assert not client.service_is_ready()

    inbox = Inbox(session.bell, None, lambda: answer())

    def answer() -> None:
        request = inbox.items.popleft()
        request.reply(AddTwoInts.Response(sum=3).to_bytes(), request.attachment)

    session.open_server(here.data_key, inbox)
    await graph.settle()
    assert ready.done()
    assert client.service_is_ready()
    assert (await call).sum == 3


async def test_waiting_for_a_server_ends_with_the_client(graph: Graph) -> None:
    """A client that is closed tells those who wait for its server."""
    asker = Node("asker")
    client = asker.create_client(AddTwoInts, "add")
    await graph.start(asker)
    ready = asyncio.ensure_future(client.wait_ready())
    await graph.settle()
    client.close()
    with pytest.raises(ClosedError, match="was closed while a call waited"):
        await ready
