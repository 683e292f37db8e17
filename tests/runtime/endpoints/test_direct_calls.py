"""Calls between graphflow processes go by lines of their own; everybody else's are queries."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest

from graphflow import Node, ServerLost, service
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.endpoints import direct_calls
from graphflow.runtime.endpoints.direct_calls import EARLY_BOUND, ServerLines
from graphflow.runtime.endpoints.service_client import ServiceClient
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.transport.inbox import REQUESTS_BOUND, Inbox
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity, Kind
from tests.cases import slow

REQUEST = AddTwoInts.Request(a=2, b=3)


class Adder(Node):
    """Adds, when it is let."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.gate = asyncio.Event()
        self.gate.set()
        self.asked = 0

    @service(AddTwoInts, "/add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        self.asked += 1
        await self.gate.wait()
        return AddTwoInts.Response(sum=request.a + request.b)


class Asker(Node):
    """Has a client."""


async def asker(graph: Graph) -> tuple[Asker, ServiceClient[Any, Any], list[int]]:
    """A node, its client, and the number of each call that goes as a query."""
    node = Asker()
    client = node.create_client(AddTwoInts, "/add")
    await graph.start(node)
    await graph.settle()
    queries: list[int] = []
    caller: Any = client._caller
    really_call = caller.call

    def call(payload: bytes, beside: bytes, answered: Any) -> Any:
        queries.append(attachment.unpack(beside).sequence)
        return really_call(payload, beside, answered)

    caller.call = call
    return node, client, queries


@slow
async def test_a_call_to_a_graphflow_server_is_no_query(graph: Graph) -> None:
    """Whichever of the two came first."""
    _, client, queries = await asker(graph)
    adder = Adder()
    await graph.start(adder)
    await graph.settle()
    assert (await client.call(REQUEST)).sum == 5
    later = Adder("other_server")
    await graph.stop(adder)
    await graph.start(later)
    await graph.settle()
    assert (await client.call(REQUEST)).sum == 5
    assert queries == []


async def test_with_two_servers_every_call_is_a_query(graph: Graph) -> None:
    """As in ROS 2, both receive it; once only one is left, it is called directly again."""
    first, second = Adder("first"), Adder("second")
    await graph.start(first)
    _, client, queries = await asker(graph)
    assert (await client.call(REQUEST)).sum == 5
    await graph.start(second)
    await graph.settle()
    assert (await client.call(REQUEST)).sum == 5
    await graph.settle()
    assert (queries, first.asked, second.asked) == ([2], 2, 1)
    await graph.stop(first)
    await graph.settle()
    assert (await client.call(REQUEST)).sum == 5
    assert (queries, second.asked) == ([2], 2)


async def test_a_call_under_way_outlives_the_coming_of_another_server(graph: Graph) -> None:
    """The first server still answers it."""
    first = Adder("first")
    await graph.start(first)
    _, client, _ = await asker(graph)
    first.gate.clear()
    answer = asyncio.ensure_future(client.call(REQUEST))
    await graph.settle()
    await graph.start(Adder("second"))
    await graph.settle()
    first.gate.set()
    assert (await answer).sum == 5


@pytest.mark.parametrize("is_heard", [True, False])
async def test_a_query_carries_a_chain_to_graphflow_alone(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, is_heard: bool
) -> None:
    """Who listens for lines understands chains, even when its word that it is heard has yet to come."""
    await graph.start(Adder())
    node, client, _ = await asker(graph)
    line, caller, carried = client._line, client._caller, []
    assert line is not None
    assert caller is not None
    really_call = caller.call

    def call(payload: Any, beside: bytes, answered: Any) -> Any:
        carried.append(beside[attachment.SIZE :])
        return really_call(payload, beside[: attachment.SIZE], answered)

    line.is_open = False
    monkeypatch.setattr(caller, "call", call)
    monkeypatch.setattr(client, "_is_own", lambda: False)
    monkeypatch.setattr(type(line._sender), "is_wanted", is_heard)
    monkeypatch.setattr(node.context.search, "chain", lambda call: b"chain")
    assert (await client.call(REQUEST)).sum == 5
    assert carried == [b"chain" if is_heard else b""]


async def test_a_server_of_another_kind_gets_queries(graph: Graph) -> None:
    """A ROS 2 server does not know lines."""
    _, client, queries = await asker(graph)
    session = graph.network.session(client.host.context.loop)
    entity = client.entity
    assert entity is not None

    def asked() -> None:
        request = inbox.items.popleft()
        request.reply(AddTwoInts.Response(sum=9).to_bytes(), request.attachment)

    inbox = Inbox(session.bell, None, asked)
    session.open_server(entity.data_key, inbox)
    session.announce(entity._replace(zid="5", kind=Kind.SERVICE, eid=7).token)
    await graph.settle()
    assert (await client.call(REQUEST)).sum == 9
    assert queries == [1]


async def test_a_server_that_goes_without_a_word_is_lost(graph: Graph) -> None:
    """The end of its token reports it, as when its process is killed."""
    adder = Adder()
    await graph.start(adder)
    _, client, queries = await asker(graph)
    adder.gate.clear()
    answer = asyncio.ensure_future(client.call(REQUEST))
    await graph.settle()
    (server,) = client.matched.values()
    client.host.context._token(server.token, False)
    with pytest.raises(ServerLost, match="went away before it answered"):
        await answer
    assert queries == []


async def test_a_client_that_goes_takes_its_line_along(graph: Graph) -> None:
    """The server drops the line, and its response is discarded."""
    adder = Adder()
    await graph.start(adder)
    node, client, _ = await asker(graph)
    (server,) = [e for e in core_of(adder).parts if getattr(e, "name", "") == "/add"]
    lines: Any = getattr(server, "_lines")  # noqa: B009
    assert len(lines._senders) == 1
    adder.gate.clear()
    answer = asyncio.ensure_future(client.call(REQUEST))
    await graph.settle()
    await graph.stop(node)
    await graph.settle()
    assert lines._senders == {}
    adder.gate.set()
    await graph.settle()
    assert lines._unanswered == 0
    assert isinstance(answer.exception(), Exception)


@pytest.mark.parametrize("where", [b"", b"1", b"1/x", b"*/2", b"1/2/3", b"\xff/1", b"@/1"])
async def test_a_hello_from_nowhere_is_ignored(graph: Graph, where: bytes) -> None:
    """It opens no line, and the server keeps working."""
    adder = Adder()
    await graph.start(adder)
    _, client, _ = await asker(graph)
    (server,) = client.matched.values()
    session = graph.network.session(client.host.context.loop)
    sender = session.open_sender(f"@graphflow/{server.domain}/ask/{server.zid}/{server.eid}", client.qos)
    sender.put(where, attachment=attachment.pack(0, 0, b"stranger" * 2))
    sender.put(b"rubbish", attachment=b"rubbish")
    sender.put(REQUEST.to_bytes(), attachment=attachment.pack(1, 0, b"stranger" * 2))
    await graph.settle()
    assert adder.asked == 0
    assert (await client.call(REQUEST)).sum == 5


async def test_an_answer_that_nobody_waits_for_is_ignored(graph: Graph) -> None:
    """It may be late or forged."""
    await graph.start(Adder())
    _, client, _ = await asker(graph)
    entity = client.entity
    assert entity is not None
    session = graph.network.session(client.host.context.loop)
    sender = session.open_sender(f"@graphflow/{entity.domain}/answer/{entity.zid}/{entity.eid}", client.qos)
    for sequence in (1, -1, 77):
        sender.put(b"", attachment=attachment.pack(sequence, 0, bytes(16)))
    sender.put(b"", attachment=b"")
    await graph.settle()
    assert (await client.call(REQUEST)).sum == 5


class Lines:
    """A switchboard that counts the ways back that are opened."""

    def __init__(self) -> None:
        self.opened: list[tuple[str, str]] = []

    def listen(self, *_: Any) -> None:
        """Ignore arrivals."""

    def open_sender(self, what: str, zid: str, eid: str, changed: Any) -> Any:
        self.opened.append((zid, eid))
        return SimpleNamespace(is_wanted=False, close=lambda: None)


def client_entity(number: int) -> Entity:
    return Entity(0, "abc", 1, number, Kind.CLIENT, "/", "asker", "/add", AddTwoInts.NAME, "RIHS01_0")


def lines() -> tuple[Lines, ServerLines]:
    made: Any = Lines()
    return made, ServerLines(made, client_entity(99), None, lambda _: None)  # type: ignore[arg-type]


def hello(server: ServerLines, client: Entity, where: str = "") -> None:
    server._heard((where or f"{client.zid}/{client.eid}").encode(), b"", 0, client.gid)


def test_hellos_of_strangers_open_nothing() -> None:
    """Their number is limited."""
    board, server = lines()
    server.client_came(client_entity(1))
    for i in range(2 * EARLY_BOUND):
        hello(server, client_entity(100 + i))
    assert board.opened == []
    assert len(server._early) == EARLY_BOUND


def test_a_hello_may_come_before_the_token() -> None:
    """The line opens with the token, and only to the key in the token."""
    board, server = lines()
    server.client_came(client_entity(1))
    hello(server, client_entity(2))
    hello(server, client_entity(3), "abc/7")
    assert board.opened == []
    server.client_came(client_entity(2))
    server.client_came(client_entity(3))
    assert board.opened == [("abc", "2")]
    hello(server, client_entity(1), "def/1")
    assert board.opened == [("abc", "2")]
    hello(server, client_entity(1))
    hello(server, client_entity(1))
    assert board.opened == [("abc", "2"), ("abc", "1")]


@pytest.mark.parametrize("sequence", [-1, -(2**63)])
def test_a_request_has_a_number_that_counts_up(sequence: int) -> None:
    """Negative numbers mark errors and are not valid in requests."""
    made: Any = Lines()
    asked: list[Any] = []
    server = ServerLines(made, client_entity(99), None, asked.append)  # type: ignore[arg-type]
    client = client_entity(1)
    server.client_came(client)
    hello(server, client)
    server._heard(b"", attachment.pack(1, 0, client.gid), 1, client.gid)
    server._heard(b"", attachment.pack(sequence, 0, client.gid), sequence, client.gid)
    assert len(asked) == 1


def test_a_hello_that_is_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is cut, and so opens nothing and takes little memory."""
    monkeypatch.setattr(direct_calls, "_WHERE_BOUND", 10)
    board, server = lines()
    hello(server, client_entity(1), "x" * 1000)
    assert [*server._early.values()] == ["x" * 10]
    assert board.opened == []


async def test_how_much_may_wait(graph: Graph) -> None:
    """Requests as many as in other queues, and ten times as many answers."""
    node, _, _ = await asker(graph)
    board: Any = node.context.switchboard
    for what, depth in (("ask", REQUESTS_BOUND), ("answer", 10 * REQUESTS_BOUND)):
        board.listen(what, client_entity(1), lambda *_: None)
        assert board._inboxes[what].depth == depth


def test_what_was_refused_is_told_with_the_limit(caplog: pytest.LogCaptureFixture) -> None:
    """In megabytes."""
    inbox: Any = SimpleNamespace(dropped=3, depth=7)
    direct_calls.warn_of_refused(inbox, "requests")
    assert "requests: 3 were refused so far, since 7 of them, or 256 MB, waited" in caplog.text
