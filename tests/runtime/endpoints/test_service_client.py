"""Calls: their servers, their deadlines, and the names of their failures."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from graphflow import CallTimeout, DecodeError, EncodeError, Node, RemoteError, ServerLost, ServiceUnavailable, service
from graphflow.errors import ClosedError, LoopBlockedError
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.nav_msgs.msg import OccupancyGrid
from graphflow.msgs.nav_msgs.srv import SetMap
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.runtime.endpoints.service_client import ServiceClient
from graphflow.testing import Graph
from graphflow.transport.inbox import Inbox
from graphflow.wire import attachment
from graphflow.wire.liveliness import Kind
from tests.cases import slow
from tests.runtime.cast import Adder, Log, SlowAdder, begun, client_of

pytestmark = pytest.mark.usefixtures("way")


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
        "no node offers the service /ad [example_interfaces/srv/AddTwoInts]; did you mean '/add'?"
    )


async def test_a_service_of_another_type(graph: Graph) -> None:
    """The error has the service's type."""
    await graph.start(Adder())
    call = asyncio.create_task(graph.call(Trigger, "/add", Trigger.Request()))

    await graph.clock.advance(1.0)

    with pytest.raises(ServiceUnavailable) as caught:
        await call
    assert str(caught.value) == "service /add is of type example_interfaces/srv/AddTwoInts, not std_srvs/srv/Trigger"


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


@slow
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
    with pytest.raises(
        CallTimeout, match=r"^/add did not answer within 2\.5 s($|; service add of /slow_adder)"
    ) as caught:
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
    """A response to a finished call is discarded, and not taken for the next call's."""
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


async def test_a_call_with_a_wrong_request(graph: Graph) -> None:
    """EncodeError names the service and its type, or the field; no request is sent."""
    server = SlowAdder()
    await graph.start(server)
    client = await client_of(graph)

    with pytest.raises(EncodeError, match=r"/add takes AddTwoInts.*Request, not example_interfaces.*Response"):
        await client.call(AddTwoInts.Response())  # type: ignore[arg-type]
    maps: Any = server.create_client(SetMap, "/set_map")
    with pytest.raises(EncodeError, match=r"; write SetMap\.Request\(map=\.\.\.\)$"):
        await maps.call(OccupancyGrid())
    wrong = AddTwoInts.Request()
    wrong.a = "one"  # type: ignore[assignment]
    with pytest.raises(EncodeError, match="a"):
        await client.call(wrong)
    await graph.settle()

    assert server.asked == []


async def test_a_call_with_a_negative_timeout(graph: Graph) -> None:
    """It is a slip, and no call that cannot be answered in time."""
    node = Node("n")
    client = node.create_client(AddTwoInts, "add")
    await graph.start(node)
    with pytest.raises(ValueError, match="is in seconds, and cannot be -1; None waits for ever"):
        await client.call(AddTwoInts.Request(), timeout=-1)


async def test_a_call_needs_a_running_node(graph: Graph) -> None:
    """A call before the start raises an error."""
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
    """With a timeout it returns False when that has passed, and True when there is a server."""
    client = await client_of(graph)
    waiting = asyncio.create_task(client.wait_ready(timeout=5.0))
    await graph.clock.advance(4.9)
    assert not waiting.done()

    await graph.clock.advance(0.1)

    assert await waiting is False
    await graph.start(Adder())
    assert await client.wait_ready(timeout=5.0) is True


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
    """Closing a client ends its waits for a server."""
    asker = Node("asker")
    client = asker.create_client(AddTwoInts, "add")
    await graph.start(asker)
    ready = asyncio.ensure_future(client.wait_ready())
    await graph.settle()
    client.close()
    with pytest.raises(ClosedError, match="was closed while a call waited"):
        await ready


@slow
async def test_an_error_text_clears_no_screen(graph: Graph) -> None:
    """Escape sequences in a handler's error, which may be another process's data, are spelt out; line breaks stay."""

    class Rude(Node):
        @service(AddTwoInts, "add")
        async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
            raise ValueError("\x1b[2Jone\ntwo\x9b31m")

    await graph.start(Rude())
    client = await client_of(graph)
    with pytest.raises(RemoteError) as caught:
        await client.call(AddTwoInts.Request())

    assert caught.value.message == "\\x1b[2Jone\ntwo\\x9b31m"
    assert str(caught.value) == f"the handler of /add raised ValueError: {caught.value.message}"


async def test_calling_from_a_thread(graph: Graph) -> None:
    """`call_sync` blocks a thread until the answer is there, and refuses to block the loop that has to receive it."""
    await graph.start(Adder())
    client = await client_of(graph)
    asked = AddTwoInts.Request(a=1, b=2)

    assert (await asyncio.to_thread(client.call_sync, asked)).sum == 3
    with pytest.raises(LoopBlockedError, match="/add: call_sync would block the event loop"):
        client.call_sync(asked)
