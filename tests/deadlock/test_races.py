"""Lost updates of a node's attributes: reported when they are, and not when they only look like it."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import Group, Node, Param, timer
from graphflow.deadlock import races
from graphflow.testing import Graph


class Counter(Node):
    """Two handlers that overlap: `slow` is at its await when `quick` runs."""

    x = 0
    flag = False
    rate = Param(1.0)
    one = Group(1)

    async def wait(self) -> None:
        await self.clock.sleep(0.5)


@pytest.fixture(autouse=True)
def switched_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(races.VARIABLE, "1")


async def reports(graph: Graph, caplog: pytest.LogCaptureFixture, cls: type[Node]) -> list[str]:
    """What is told while both handlers run for a while."""
    await graph.start(cls())
    await graph.clock.advance(5.0)
    return [m for m in caplog.messages if m.startswith("RACE")]


async def test_a_lost_update(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Both lines, both handlers, and the group that would prevent it, once."""

    class Lost(Counter):
        @timer(1.0)
        async def slow(self) -> None:
            old = self.x
            await self.wait()
            new = old + 1
            self.x = new

        @timer(0.3)
        async def quick(self) -> None:
            self.x = self.x + 10

    [told] = await reports(graph, caplog, Lost)
    first = Lost.slow.__code__.co_firstlineno + 2
    assert f"timer slow of /lost read it in test_races.py:{first} and waited," in told
    assert f"timer quick wrote it meanwhile in test_races.py:{Lost.quick.__code__.co_firstlineno + 2}," in told
    assert f"timer slow has overwritten that in test_races.py:{first + 3}." in told
    assert told.endswith("/lost: {concurrency: {state: [slow, quick]}}")
    record = next(r for r in caplog.records if r.getMessage() == told)
    assert (record.pathname, record.lineno) == (__file__, first + 3)


async def plus(self: Any) -> None:
    self.x += await later(self)


async def reads(self: Any) -> None:
    before = self.x
    await self.wait()
    assert isinstance(self.x - before, int)


async def sets(self: Any) -> None:
    assert self.x is not None
    await self.wait()
    self.x = 7


async def writes_first(self: Any) -> None:
    self.x = self.x + 1
    await self.wait()


async def reads_again(self: Any) -> None:
    assert self.x is not None
    await self.wait()
    self.x = self.x + 1


async def writes_the_same(self: Any) -> None:
    old = self.x
    await self.wait()
    self.x = old + 1000 - 1000 + (self.x - old)


async def later(self: Any) -> int:
    await self.wait()
    return 1


def bump(self: Any) -> None:
    self.x = self.x + 10


@pytest.mark.parametrize(
    ("slow", "quick", "told"),
    [
        (plus, bump, 1),
        (reads, bump, 0),
        (sets, bump, 0),
        (writes_first, bump, 0),
        (reads_again, bump, 0),
        (writes_the_same, bump, 0),
    ],
)
async def test_what_is_lost_and_what_is_not(
    graph: Graph, caplog: pytest.LogCaptureFixture, slow: Any, quick: Any, told: int
) -> None:
    """An update is; reading, setting anew, writing before the wait, reading again after it, and no change are not."""

    class Overlapping(Counter):
        def __init__(self) -> None:
            super().__init__()
            self.create_timer(1.0, lambda: slow(self))
            self.create_timer(0.3, lambda: quick(self))

    assert len(await reports(graph, caplog, Overlapping)) == told


async def test_a_flag_that_was_checked_is_overwritten(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """What stands behind an `if` that asks for the attribute comes of its old value."""

    class Flagged(Counter):
        @timer(1.0)
        async def slow(self) -> None:
            if self.flag:
                await self.wait()
                self.flag = False

        @timer(0.7)
        def quick(self) -> None:
            self.flag = True

    await graph.start(node := Flagged())
    node.flag = True
    await graph.clock.advance(3.0)
    assert sum(m.startswith("RACE: an update of self.flag is lost") for m in caplog.messages) == 1


async def test_a_group_prevents_it(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Handlers that exclude each other lose nothing, and nothing is told."""

    class Exclusive(Counter):
        @timer(1.0, group=Counter.one)
        async def slow(self) -> None:
            await plus(self)

        @timer(0.3, group=Counter.one)
        async def quick(self) -> None:
            self.x = self.x + 10

    assert await reports(graph, caplog, Exclusive) == []


async def test_a_watched_node_is_as_it_was(graph: Graph) -> None:
    """Its class, parameters, groups and attributes; and when it is switched off, nothing is looked at."""
    node = Counter(rate=3.0)
    await graph.start(node)
    assert isinstance(node, Counter)
    assert (type(node).__name__, node.rate, node.x, node.one.limit) == ("Counter", 3.0, 0, 1)
    node.x = 4
    assert vars(node)["x"] == 4


async def test_it_is_off_by_default(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Then a node keeps its own class, whose attributes cost what they cost."""
    monkeypatch.delenv(races.VARIABLE)
    node = Counter("plain")
    await graph.start(node)
    assert type(node) is Counter
    await asyncio.sleep(0)
