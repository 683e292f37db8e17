"""Subscriptions whose messages all exceed their lifespan."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from graphflow.executor.clock import Clock
from graphflow.runtime.mistakes.expiry import MANY, Expiry
from graphflow.testing import Graph

Caplog = pytest.LogCaptureFixture


class _Host:
    log = logging.getLogger("graphflow.test")

    def __init__(self, clock: Clock) -> None:
        self.clock, self.context = clock, self


async def test_all_of_them(graph: Graph, caplog: Caplog) -> None:
    """They are told once, after some seconds."""
    host: Any = _Host(graph.clock)
    expiry = Expiry(host, "/b")
    for number in range(1, 3 * MANY):
        expiry.add(number, 500_000, 1_250_000)
        await graph.clock.advance(1.0)
    assert caplog.messages == [
        f"/b: all {MANY} messages so far have exceeded their lifespan of 500 us, the last by 1.25 ms, and are dropped: "
        "give it a longer lifespan"
    ]
    assert expiry.count == 3 * MANY - 1


async def test_another_clock(graph: Graph, caplog: Caplog) -> None:
    """Is suspected where a message is late by seconds."""
    host: Any = _Host(graph.clock)
    expiry = Expiry(host, "/b")
    for number in range(1, MANY + 1):
        expiry.add(number, 2 * 10**9, 90 * 10**9)
        await graph.clock.advance(1.0)
    assert caplog.messages[0].endswith("a longer lifespan; are the clocks of the two machines the same?")


async def test_some_of_them(graph: Graph, caplog: Caplog) -> None:
    """Is not told: those of a moment, as after a blocked loop, and those between others that were in time."""
    host: Any = _Host(graph.clock)
    burst, mixed = Expiry(host, "/a"), Expiry(host, "/b")
    await graph.clock.advance(60.0)
    for number in range(1, 100):
        burst.add(number, 500, 10**12)
    await graph.clock.advance(60.0)
    burst.add(101, 500, 10**12)
    for number in range(1, 100):
        mixed.add(2 * number, 500, 10**12)
        await graph.clock.advance(1.0)
    assert caplog.messages == []
