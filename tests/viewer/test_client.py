"""What waits to be sent to a viewer."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow.viewer import client

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Connection:
    """Stands for one that takes nothing."""

    def __init__(self) -> None:
        self.transport = self
        self.is_aborted = False

    def abort(self) -> None:
        self.is_aborted = True


def made() -> tuple[client.Client, Connection]:
    connection: Any = Connection()
    return client.Client(connection), connection


def test_messages_that_are_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """The oldest are left out, which is told once; nothing grows for ever."""
    monkeypatch.setattr(client, "DATA_BOUND", 1000)
    slow, connection = made()
    for number in range(100):
        slow.show(b"head", bytes([number]) * 96)
    assert (slow.dropped, len(slow._data)) == (90, 10)
    assert slow._data[0][4] == 90
    slow.show(b"head", bytes(5000))
    assert len(slow._data) == 1
    [word] = slow._words
    assert "this viewer reads too slowly" in str(word)
    assert not connection.is_aborted


def test_words_that_are_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is sent away, whatever waits; long texts are cut before."""
    monkeypatch.setattr(client, "WORDS_BOUND", 10_000)
    slow, connection = made()
    slow.warn("x" * 1_000_000)
    assert not connection.is_aborted
    slow.say("y" * 9_000)
    assert not connection.is_aborted
    slow.say("y" * 1_000)
    assert connection.is_aborted
    assert not slow._words


async def test_work_that_fails(caplog: pytest.LogCaptureFixture) -> None:
    """Is told, whatever it was."""
    found, _ = made()

    async def wrong() -> None:
        raise RuntimeError("no good")

    found.begin(wrong)
    await asyncio.gather(*found._work)
    assert "no good" in str(found._words[0])
    assert "a request of a viewer has failed" in caplog.text
