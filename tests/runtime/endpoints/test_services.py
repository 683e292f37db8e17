"""Services at work."""

from __future__ import annotations

import asyncio
import re
from typing import Any

import pytest

from graphflow import Node, RemoteError, ServerBusy, ServerLost, service
from graphflow.errors import ClosedError
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_srvs.srv import Empty, Trigger
from graphflow.runtime.endpoints import direct_calls, services
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.transport.base import Answer
from graphflow.wire import attachment
from tests.runtime.cast import Adder, SlowAdder, begun, client_of

pytestmark = pytest.mark.usefixtures("way")


async def nothing() -> None:
    """Do nothing."""


@pytest.mark.parametrize("name", ["add", "add_plain", "add_in_thread"])
async def test_a_service_answers(graph: Graph, name: str) -> None:
    """A handler may be a coroutine, a function, or a function in a thread."""
    await graph.start(Adder())

    response = await graph.call(AddTwoInts, f"/{name}", AddTwoInts.Request(a=2, b=40))

    assert response == AddTwoInts.Response(sum=42)


async def test_an_empty_response_may_be_none(graph: Graph) -> None:
    """A handler without a result need not return one."""
    await graph.start(Adder())

    assert await graph.call(Empty, "/go", Empty.Request()) == Empty.Response()


@pytest.mark.parametrize(
    ("name", "type_", "text"),
    [
        ("raises", "ValueError", "^7 is too much$"),
        ("raises_plainly", "KeyError", "^'lost'$"),
        ("wrong_type", "TypeError", r"it returned std_srvs.*not .*AddTwoInts.*Response"),
        ("returns_nothing", "TypeError", "it returned None: end it with return AddTwoInts.Response(...)"),
        ("wrong_field", "EncodeError", "sum"),
        ("cancelled_inside", "CancelledError", ""),
    ],
)
async def test_a_failing_service_tells_its_caller(
    graph: Graph, caplog: pytest.LogCaptureFixture, name: str, type_: str, text: str
) -> None:
    """The caller gets the remote type and text; the server logs the error and continues with the next request."""
    await graph.start(Adder())

    for _ in range(2):
        with pytest.raises(RemoteError) as caught:
            await graph.call(AddTwoInts, f"/{name}", AddTwoInts.Request(a=7))
        assert caught.value.type == type_
        assert re.search(text, caught.value.message)

    assert [r.name for r in caplog.records] == ["graphflow.node.adder"] * (0 if type_ == "CancelledError" else 2)


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


class Gate(Node):
    """Answer only once opened."""

    def __init__(self) -> None:
        super().__init__()
        self.open = asyncio.Event()

    @service(Trigger, "pass")
    async def let_in(self, _: Trigger.Request) -> Trigger.Response:
        await self.open.wait()
        return Trigger.Response(success=True)


async def test_a_full_service_refuses_the_newest(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Waiting requests are answered in the end; further ones are refused at once."""
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


async def test_a_service_bounds_the_bytes_that_wait(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """As it does their number; the request that waits alone may have any size."""
    monkeypatch.setattr(services, "BYTES_BOUND", 8)
    gate, caller = Gate(), Node("caller")
    client = caller.create_client(Trigger, "pass")
    await graph.start(gate, caller)
    calls = [asyncio.ensure_future(client.call(Trigger.Request())) for _ in range(4)]
    await graph.settle()

    gate.open.set()
    await graph.settle()
    results = await asyncio.gather(*calls, return_exceptions=True)

    assert [type(r) for r in results] == [Trigger.Response] * 2 + [ServerBusy] * 2
    assert "MB of requests waiting" in str(results[-1])


async def test_a_flood_while_the_loop_is_blocked(
    graph: Graph, way: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It is refused before it exhausts the memory; each call ends at once, and a warning has the number."""
    monkeypatch.setitem(direct_calls._DEPTH, "ask", 3)
    monkeypatch.setattr(services, "REQUESTS_BOUND", 3)
    caller = Node("caller")
    client = caller.create_client(AddTwoInts, "add")
    server = Adder()
    await graph.start(server, caller)
    await graph.settle()
    calls = [asyncio.ensure_future(client.call(AddTwoInts.Request(a=1, b=1))) for _ in range(10)]
    results = await asyncio.gather(*calls, return_exceptions=True)

    refused = ServerBusy if way == "direct" else ServerLost
    assert [type(r) for r in results] == [AddTwoInts.Response] * 3 + [refused] * 7
    assert any("were refused so far, since 3 of them" in r.getMessage() for r in caplog.records)


async def test_a_closed_client_ends_its_calls(graph: Graph) -> None:
    """No call waits for a response that cannot be delivered."""
    caller = Node("caller")
    client = caller.create_client(Trigger, "pass")
    await graph.start(Gate(), caller)
    call = asyncio.ensure_future(client.call(Trigger.Request(), timeout=None))
    await graph.settle()

    client.close()

    with pytest.raises(ClosedError, match="the client of /pass was closed"):
        await call


async def test_two_servers_of_one_node(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The warning names both handlers; a closed server does not count."""
    node = Node("clerk")

    async def add(request: Any) -> Any: ...

    async def add_too(request: Any) -> Any: ...

    await graph.start(node)
    node.create_service(AddTwoInts, "add", add).close()
    node.create_service(AddTwoInts, "add", add)
    node.create_service(AddTwoInts, "other", add)
    node.create_service(AddTwoInts, "/add", add_too)
    [text] = [record.getMessage() for record in caplog.records if "twice" in record.getMessage()]
    first, second = (f"{__file__}:{fn.__code__.co_firstlineno}" for fn in (add, add_too))
    assert text == (
        f"/add is offered twice by this node, by service add ({first}) and service add_too ({second}): "
        "each call reaches both; keep one"
    )
