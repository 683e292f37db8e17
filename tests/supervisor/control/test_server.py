"""The control socket: whoever may ask is answered, on either kind of address, and nobody else."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import socket
import stat
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import SupervisorError
from graphflow.graph.plan import Plan
from graphflow.supervisor.control import server as control_server
from graphflow.supervisor.control.client import ControlClient
from graphflow.supervisor.control.clients import Clients
from graphflow.supervisor.control.server import ControlServer
from graphflow.system import is_portable
from graphflow.testing.clock import settle

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Graph:
    """A graph of one node that is asked things, and tells nothing by itself."""

    plan = Plan("g", "g.yaml", "/", ())
    components: Any = None

    def __init__(self) -> None:
        self.stopped: list[str] = []
        self.asked: list[tuple[str, ...]] = []
        self.emptied = 0
        self.clients = Clients(self._empty)

    def _empty(self) -> None:
        self.emptied += 1

    def hello(self) -> Any:
        return {"event": "hello", "graph": "g", "layout": self.clients.layout}

    def describe(self) -> Any:
        return [{"node": "/a"}]

    def begin_stop(self, *, now: bool, reason: str) -> None:
        self.stopped.append(reason)

    def restart(self, node: str, by: str, *, only_ended: bool = False, threads: Sequence[str] = ()) -> None:
        if node != "/a":
            raise SupervisorError(f"graph g has no node {node}")
        self.asked.append(("start" if only_ended else "restart", node, by, *threads))

    def stop(self, node: str, by: str) -> None:
        self.asked.append(("stop", node, by))


@pytest.fixture(params=["", "1"], ids=["unix", "portable"])
def portable(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> bool:
    monkeypatch.setenv("GRAPHFLOW_PORTABLE", request.param)
    return bool(request.param)


def ask(address: str) -> list[dict[str, Any]]:
    with ControlClient(address) as client:
        client.send(do="ps")
        return list(client.receive(5.0))


def say(address: str, line: bytes) -> bytes:
    """Return the answer to a line from a stranger on the machine."""
    with socket.create_connection(("127.0.0.1", int(address.split("/")[1])), 5.0) as connection:
        connection.sendall(line)
        return connection.recv(4096)


async def test_a_request_is_answered(portable: bool, tmp_path: Path) -> None:
    """On a Unix socket that only its owner may open, or on loopback with the token of the address."""
    server = ControlServer(Graph())
    address = await server.open(tmp_path / "server.sock")
    assert address.startswith("tcp/") is portable
    if not portable:
        assert stat.S_IMODE(os.stat(address).st_mode) == 0o600
    assert await asyncio.to_thread(ask, address) == [{"event": "ps", "nodes": [{"node": "/a"}], "consoles": []}]
    await server.close()
    with pytest.raises(SupervisorError, match="does not answer"):
        await asyncio.to_thread(ask, address)


@pytest.mark.parametrize("token", [None, "", "0" * 32])
async def test_without_the_token_nothing_is_done(
    token: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process that reaches the port but cannot read the run file gets no answer, and stops nothing."""
    monkeypatch.setenv("GRAPHFLOW_PORTABLE", "1")
    graph = Graph()
    server = ControlServer(graph)
    address = await server.open(tmp_path / "server.sock")
    request: dict[str, Any] = {"do": "down"} if token is None else {"do": "down", "token": token}
    assert await asyncio.to_thread(say, address, json.dumps(request).encode() + b"\n") == b""
    assert graph.stopped == []
    await server.close()


async def test_nobody_is_waited_for_who_has_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A graph waits for its command to hear how it ends, unless that is known to have ended."""
    monkeypatch.setattr(control_server, "FOLLOW_LIMIT", 60.0)
    server = ControlServer(Graph())
    waiting = asyncio.create_task(server.wait_followed())
    await settle()
    assert not waiting.done()
    server.expect_nobody()
    await asyncio.wait_for(waiting, 5.0)


async def test_a_stop_that_comes_late(portable: bool, tmp_path: Path) -> None:
    """A graph that has just ended says so to one who wants to stop it, and waits for nothing more."""
    graph = Graph()
    server = ControlServer(graph)
    address = await server.open(tmp_path / "server.sock")
    graph.clients.broadcast({"event": "note", "text": "/a"})
    graph.clients.broadcast({"event": "end", "exit_code": 1})

    def take_down() -> list[str]:
        with ControlClient(address) as client:
            client.send(do="down", now=False)
            return [event["event"] for event in client.receive()]

    assert await asyncio.wait_for(asyncio.to_thread(take_down), 5.0) == ["note", "end"]
    await server.close()


def test_a_reason_that_is_too_long() -> None:
    """It is cut, since it goes to every client and into every log."""
    line = json.dumps({"do": "down", "reason": "x" * 10_000}).encode()
    assert control_server._Request.parse(line).reason == "x" * 200


@pytest.mark.skipif(is_portable(), reason="a port has a token instead")
@pytest.mark.parametrize(("uid", "is_served"), [(None, True), (os.getuid(), True), (os.getuid() + 1, False)])
async def test_another_user_is_not_served(
    uid: int | None, is_served: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even if the socket's permissions let it in; who is unknown has passed them."""
    monkeypatch.setattr(control_server, "_peer_uid", lambda _: uid)
    server = ControlServer(Graph())
    address = await server.open(tmp_path / "server.sock")
    reader, writer = await asyncio.open_unix_connection(address)
    writer.write(b'{"do": "ps"}\n')
    answer = b""
    with contextlib.suppress(ConnectionResetError):
        answer = await reader.read()
    writer.close()
    await server.close()
    assert bool(answer) is is_served


@pytest.mark.skipif(is_portable(), reason="a port has no user")
def test_the_user_at_the_other_end() -> None:
    """As the kernel knows it."""
    mine, its = socket.socketpair()
    with mine, its:
        assert control_server._peer_uid(mine) == os.getuid()
