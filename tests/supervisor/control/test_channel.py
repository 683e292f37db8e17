"""Lines of JSON over a descriptor."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import socket
import sys
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest

from graphflow.supervisor.control.channel import Lines

pytestmark = [
    pytest.mark.usefixtures("graphflow_runner"),
    pytest.mark.skipif(sys.platform == "win32", reason="only forked workers talk so"),
]


class Listener:
    """Collects events, and the loss of the other end."""

    def __init__(self) -> None:
        self.events = asyncio.Queue[dict[str, Any]]()
        self.lost = asyncio.Event()

    async def hear(self, count: int) -> list[dict[str, Any]]:
        return [await self.events.get() for _ in range(count)]

    def listen(self, channel: socket.socket | int) -> Lines[dict[str, Any]]:
        return Lines(channel, self.events.put_nowait, self.lost.set)


@pytest.fixture
def pair() -> Iterator[tuple[socket.socket, socket.socket]]:
    mine, other = socket.socketpair()
    with mine, other:
        yield mine, other


async def test_events_come_however_they_are_cut(pair: tuple[socket.socket, socket.socket]) -> None:
    """Several at once, one in pieces, one longer than is read at a time."""
    mine, other = pair
    lines = (listener := Listener()).listen(mine)
    other.sendall(b'{"n": 1}\n{"n": 2}\n{"n"')
    assert await listener.hear(2) == [{"n": 1}, {"n": 2}]
    assert listener.events.empty()
    other.sendall(b": 3}\n")
    assert await listener.hear(1) == [{"n": 3}]
    long = "x" * 200_000
    await asyncio.to_thread(other.sendall, b'{"n": "' + long.encode() + b'"}\n')
    assert await listener.hear(1) == [{"n": long}]
    lines.close()


async def test_what_is_no_event_is_logged(
    pair: tuple[socket.socket, socket.socket], caplog: pytest.LogCaptureFixture
) -> None:
    """And the next one is heard."""
    mine, other = pair
    lines = (listener := Listener()).listen(mine)
    with caplog.at_level(logging.ERROR, "graphflow.supervisor"):
        other.sendall(b'nonsense\n{"n": 1}\n')
        assert await listener.hear(1) == [{"n": 1}]
    assert caplog.messages == ["not an event: b'nonsense'"]
    lines.close()


async def test_the_other_end_is_gone() -> None:
    """That is told once, after all that it has said; a pipe will do."""
    read, write = os.pipe()
    (listener := Listener()).listen(read)
    os.write(write, b'{"n": 1}\n')
    os.close(write)
    assert await listener.hear(1) == [{"n": 1}]
    await listener.lost.wait()
    listener.lost.clear()
    await asyncio.sleep(0)
    assert not listener.lost.is_set()
    os.close(read)


async def test_requests(pair: tuple[socket.socket, socket.socket]) -> None:
    """A line each; while one waits for the other end to read, nothing is lost, and events are heard afterwards."""
    mine, other = pair
    lines = (listener := Listener()).listen(mine)
    lines.send({"do": "spawn", "process": "/a"})
    lines.send({"do": "log"})
    assert other.recv(4096) == b'{"do": "spawn", "process": "/a"}\n{"do": "log"}\n'
    other.sendall(b'{"n": 1}\n')
    assert await listener.hear(1) == [{"n": 1}]
    assert mine.getblocking() is False
    lines.close()


async def test_a_request_to_one_that_does_not_read(pair: tuple[socket.socket, socket.socket]) -> None:
    """A stopped process holds nobody up: the rest goes out, in order, when it reads on."""
    mine, other = pair
    lines = Listener().listen(mine)
    for number in range(200):
        lines.send({"number": number, "job": "x" * 10_000})
    other.setblocking(False)
    data = b""
    while data.count(b"\n") < 200:
        await asyncio.sleep(0)
        with suppress(BlockingIOError):
            data += other.recv(1 << 20)
    assert [json.loads(line)["number"] for line in data.splitlines()] == list(range(200))
    lines.close()


async def test_a_request_to_nobody(pair: tuple[socket.socket, socket.socket]) -> None:
    """It raises nothing: that nobody reads any more is told soon."""
    mine, other = pair
    lines = (listener := Listener()).listen(mine)
    other.shutdown(socket.SHUT_RD)
    lines.send({"do": "spawn"})
    assert not listener.lost.is_set()
    await listener.lost.wait()
    lines.close()


async def test_after_closing_nothing_is_heard(pair: tuple[socket.socket, socket.socket]) -> None:
    """The descriptor stays its owner's."""
    mine, other = pair
    (listener := Listener()).listen(mine).close()
    other.sendall(b'{"n": 1}\n')
    await asyncio.sleep(0)
    assert listener.events.empty()
    assert mine.recv(4096) == b'{"n": 1}\n'
