"""The send queues of a viewer."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow.viewer import client

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Connection:
    """A connection that accepts messages but never reads them."""

    def __init__(self) -> None:
        self.transport = self
        self.is_aborted = False
        self.sent: list[str | bytes] = []
        self.pongs: list[asyncio.Future[float]] = []

    def abort(self) -> None:
        self.is_aborted = True

    async def send(self, frame: str | bytes) -> None:
        self.sent.append(frame)

    async def ping(self) -> asyncio.Future[float]:
        self.pongs.append(asyncio.get_running_loop().create_future())
        return self.pongs[-1]


def made() -> tuple[client.Client, Connection]:
    connection: Any = Connection()
    return client.Client(connection), connection


def test_messages_that_are_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """The oldest messages of a channel are dropped, which is reported once; channels do not affect each other."""
    monkeypatch.setattr(client, "CHANNEL_BOUND", 1000)
    slow, connection = made()
    slow.send_message(2, b"small")
    for number in range(100):
        slow.send_message(1, bytes([number]) * 100)
    assert (slow.dropped, len(slow._waiting[1])) == (90, 10)
    assert slow._waiting[1][0][0] == 90
    slow.send_message(1, bytes(5000))
    assert list(slow._waiting[1]) == [bytes(5000)]
    assert list(slow._waiting[2]) == [b"small"]
    [word] = slow._control
    assert "this viewer reads too slowly" in str(word)
    assert not connection.is_aborted
    slow.forget(1)
    slow.forget(1)
    assert list(slow._waiting) == [2]


async def settle() -> None:
    for _ in range(200):
        await asyncio.sleep(0)


async def test_a_viewer_that_reads_slowly() -> None:
    """No more is sent than the client has read; then control messages, small messages, and the latest large ones."""
    slow, connection = made()
    large = [bytes([number]) * client.WINDOW for number in range(6)]
    writing = asyncio.ensure_future(slow.write())
    for frame in large[:3]:
        slow.send_message(1, frame)
        await settle()
    assert connection.sent == large[:2]
    slow.send_message(1, large[3])
    for number in range(3):
        slow.send_message(2, bytes([number]))
    slow.send_control("a word")
    await settle()
    assert "reads too slowly" in str(connection.sent[2])
    assert connection.sent[3:] == ["a word"]
    connection.pongs[0].set_result(0.1)
    await settle()
    assert connection.sent[4:] == [b"\0", b"\1", b"\2", large[3]]
    connection.pongs[1].set_exception(ConnectionError("gone"))
    slow.send_message(1, large[4])
    await settle()
    assert connection.sent[8:] == [large[4]]
    writing.cancel()


def test_words_that_are_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """A client that exceeds the limit is disconnected; long warnings are cut."""
    monkeypatch.setattr(client, "CONTROL_BOUND", 10_000)
    slow, connection = made()
    slow.warn("x" * 1_000_000)
    assert not connection.is_aborted
    slow.send_control("y" * 9_000)
    assert not connection.is_aborted
    slow.send_control("y" * 1_000)
    assert connection.is_aborted
    assert not slow._control


async def test_work_that_fails(caplog: pytest.LogCaptureFixture) -> None:
    """A failed request is reported, whatever its error."""
    found, _ = made()

    async def wrong() -> None:
        raise RuntimeError("no good")

    found.spawn(wrong)
    await asyncio.gather(*found._work)
    assert "no good" in str(found._control[0])
    assert "a viewer's request failed" in caplog.text


async def test_large_messages_take_turns() -> None:
    """The smaller of two large topics does not starve the other."""
    slow, _ = made()
    sent: list[int] = []
    for _ in range(6):
        for channel, size in ((1, 90_000), (2, 100_000)):
            slow.send_message(channel, bytes([channel]) * size)
        sent.append(slow._next()[0])
    assert sent == [1, 2, 1, 2, 1, 2]
    slow.send_message(3, b"\x03small")
    assert slow._next()[0] == 3
