"""The server to which viewers connect: ports, pages, and viewers that misbehave."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosedError, InvalidStatus

from graphflow import Node
from graphflow.errors import TransportError
from graphflow.testing import Graph
from graphflow.viewer import client
from graphflow.viewer import server as server_module
from graphflow.viewer.bridge import Bridge
from graphflow.viewer.protocol import control_message
from tests.cases import slow
from tests.viewer.cast import Robot, served, viewer


async def test_a_port_that_is_taken(graph: Graph) -> None:
    """The error says what to do."""
    async with served(graph) as lab:
        node = Node("second")
        await graph.start(node)
        with pytest.raises(TransportError, match="take another --port"):
            await Bridge(node, "x").open("127.0.0.1", lab.port)


@pytest.mark.parametrize(
    ("origin", "is_let_in"),
    [
        ("https://app.foxglove.dev", True),
        ("http://localhost:8080", True),
        ("http://127.0.0.1:3000", True),
        ("file://", False),
        ("chrome-extension://abcdefghijklmnop", False),
        ("moz-extension://3c078156", False),
        ("app://viewer", False),
        ("https://viewer.example", True),
        ("https://evil.example", False),
        ("https://app.foxglove.dev.evil.example", False),
        ("http://localhost.evil.example", False),
        ("http://app.foxglove.dev", False),
        ("null", False),
    ],
)
async def test_pages(graph: Graph, origin: str, is_let_in: bool) -> None:
    """Pages of other origins are refused, since a browser would let them connect."""
    async with served(graph, pages=("https://viewer.example",)) as lab:
        if is_let_in:
            async with viewer(lab.port, origin):
                return
        with pytest.raises(InvalidStatus, match="403"):
            async with viewer(lab.port, origin):
                pass


HELLO = "\r\n".join(
    [
        *("GET / HTTP/1.1", "Host: x", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13"),
        *("Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Protocol: foxglove.sdk.v1", "", ""),
    ]
).encode()


@slow
async def test_viewers_that_read_nothing(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Viewers that exceed the limit are disconnected, and do not delay closing."""
    monkeypatch.setattr(client, "CONTROL_BOUND", 100_000)
    monkeypatch.setattr(server_module, "GRACE", 0.1)
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as good:
        reader, writer = await asyncio.open_connection("127.0.0.1", lab.port, limit=1024)
        writer.write(HELLO)
        assert b" 101 " in await reader.readuntil(b"\r\n\r\n")
        await good.until(lambda: len(lab.bridge._viewers.clients) == 2)
        for _ in range(20_000):
            lab.bridge._viewers.broadcast(control_message("status", level=0, message="x" * 1000))
            if len(lab.bridge._viewers.clients) == 1:
                break
            await asyncio.sleep(0)
        await good.until(lambda: len(lab.bridge._viewers.clients) <= 1)
        stuck, other = await asyncio.open_connection("127.0.0.1", lab.port, limit=1024)
        other.write(HELLO)
        assert b" 101 " in await stuck.readuntil(b"\r\n\r\n")
    writer.close()
    other.close()


async def test_a_message_that_is_too_long(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its sender is disconnected."""
    monkeypatch.setattr(server_module, "MESSAGE_BOUND", 1000)
    async with served(graph) as lab, viewer(lab.port) as seen:
        await seen.say("x" * 1001)
        await seen.until(seen._reading.done)
        with pytest.raises(ConnectionClosedError, match="1009"):
            seen._reading.result()


async def test_the_origin_of_a_page_that_is_refused(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It is told, and commands no terminal."""
    connection: Any = SimpleNamespace(respond=lambda status, _: status)
    request: Any = SimpleNamespace(headers={"Origin": "https://\x1b[31m" + "x" * 10_000})
    async with served(graph) as lab:
        refusal: Any = lab.bridge._viewers._admit(connection, request)
    assert refusal == 403
    [message] = [text for text in caplog.messages if "a web page of" in text]
    assert "\\x1b[31m" in message
    assert "\x1b" not in message
    assert len(message) < 1000
