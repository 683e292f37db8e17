"""When a process tries to become the rendezvous: by what it is told of connections, in whatever order."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import pytest

from graphflow.transport import takeover
from graphflow.transport.takeover import Takeover

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Session:
    """A session as a `Takeover` sees it."""

    def __init__(self, *routers: str) -> None:
        self.listed = list(routers)
        self.tell: Callable[[str, bool], None] = lambda zid, alive: None

    def routers(self) -> list[str]:
        return self.listed

    def watch_transports(self, changed: Callable[[str, bool], None]) -> Any:
        self.tell = changed
        return self

    def close(self) -> None:
        """Nothing is held."""


@pytest.fixture
def hosted(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Set when the process becomes the rendezvous."""
    event = threading.Event()

    class Router:
        def __init__(self) -> None:
            event.set()

        def close(self) -> None:
            """Nothing is held."""

    monkeypatch.setattr(takeover, "host", Router)
    monkeypatch.setattr(takeover, "_JITTER", 0.0)
    return event


async def guarding(session: Session) -> Takeover:
    made = Takeover(None)
    made.guard(session)  # type: ignore[arg-type]
    return made


async def happens(event: threading.Event) -> bool:
    return await asyncio.to_thread(event.wait, 10.0)


async def after_a_while(event: threading.Event) -> bool:
    """Whether it has happened when everything that was begun is done."""
    for _ in range(10):
        await asyncio.sleep(0)
    await asyncio.to_thread(lambda: None)
    return event.is_set()


async def test_a_router_that_is_still_listed_when_it_is_lost(hosted: threading.Event) -> None:
    """Zenoh tells of the end of a connection before it takes the router off its list."""
    session = Session("a")
    guard = await guarding(session)
    assert not await after_a_while(hosted)
    session.tell("a", False)
    assert await happens(hosted)
    await guard.close()


async def test_a_router_that_was_lost_before_anybody_looked(hosted: threading.Event) -> None:
    """None is there from the first."""
    guard = await guarding(Session())
    assert await happens(hosted)
    await guard.close()


async def test_a_peer_that_goes_and_a_router_that_is_back_are_no_reason(hosted: threading.Event) -> None:
    """What counts is whether any router is left."""
    session = Session("a")
    guard = await guarding(session)
    session.tell("peer", False)
    session.listed.append("b")
    session.tell("a", False)
    session.listed.remove("b")
    session.tell("a", True)
    session.tell("peer", False)
    assert not await after_a_while(hosted)
    await guard.close()
