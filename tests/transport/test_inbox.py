"""The bell and the inbox: the way of whatever arrives from a network's thread to the loop."""

from __future__ import annotations

import asyncio
import threading
from typing import NamedTuple

import pytest

from graphflow.qos import Qos
from graphflow.testing.clock import settle
from graphflow.transport import inbox as module
from graphflow.transport.inbox import Bell, DeepInbox, Inbox, RequestInbox, WeighedInbox, open_inbox, size_of


async def test_a_burst_rings_once(graphflow_runner: asyncio.Runner) -> None:
    """However much arrives before the loop turns, it is told once, and finds everything in order."""
    calls: list[list[int]] = []
    inbox = Inbox(Bell(asyncio.get_running_loop(), threads=False), 10, lambda: calls.append(list(inbox.items)))

    for n in range(5):
        inbox.put(n)
    assert calls == []
    await settle()

    assert calls == [[0, 1, 2, 3, 4]]
    assert len(inbox.items) == 5
    assert inbox.dropped == 0


async def test_a_full_inbox_drops_the_oldest(graphflow_runner: asyncio.Runner) -> None:
    """The newest items stay, and every loss is counted."""
    inbox = Inbox(Bell(asyncio.get_running_loop(), threads=False), 3, lambda: None)

    for n in range(8):
        inbox.put(n)

    assert list(inbox.items) == [5, 6, 7]
    assert (len(inbox.items), inbox.dropped) == (3, 5)


async def test_an_inbox_without_bound_keeps_all(graphflow_runner: asyncio.Runner) -> None:
    """None for the depth drops nothing."""
    inbox = Inbox(Bell(asyncio.get_running_loop(), threads=False), None, lambda: None)

    for n in range(10_000):
        inbox.put(n)

    assert len(inbox.items) == 10_000
    assert inbox.dropped == 0


async def test_what_comes_while_it_is_read_rings_again(graphflow_runner: asyncio.Runner) -> None:
    """An item put in by the reader itself is not forgotten."""
    seen: list[int] = []

    def read() -> None:
        n = inbox.items.popleft()
        seen.append(n)
        if n < 3:
            inbox.put(n + 1)

    inbox = Inbox(Bell(asyncio.get_running_loop(), threads=False), 10, read)
    inbox.put(0)
    await settle()

    assert seen == [0, 1, 2, 3]


async def test_inboxes_are_attended_in_the_order_they_rang(graphflow_runner: asyncio.Runner) -> None:
    """One ring of the bell serves every inbox that has something."""
    order: list[str] = []
    bell = Bell(asyncio.get_running_loop(), threads=False)
    first = Inbox(bell, 10, lambda: order.append("first"))
    second = Inbox(bell, 10, lambda: order.append("second"))

    second.put(1)
    first.put(2)
    await settle()

    assert order == ["second", "first"]


async def test_an_error_in_one_inbox_does_not_silence_the_others(graphflow_runner: asyncio.Runner) -> None:
    """The loop hears of the error, and the inboxes that rang after it are attended all the same."""
    loop = asyncio.get_running_loop()
    errors: list[object] = []
    loop.set_exception_handler(lambda _, context: errors.append(context.get("exception")))
    attended: list[str] = []

    def fail() -> None:
        raise ValueError("broken")

    bell = Bell(loop, threads=False)
    broken, sound = Inbox(bell, 10, fail), Inbox(bell, 10, lambda: attended.append("sound"))
    broken.put(1)
    sound.put(2)
    await settle()

    assert attended == ["sound"]
    assert [str(e) for e in errors] == ["broken"]


async def test_another_thread_wakes_the_loop(graphflow_runner: asyncio.Runner) -> None:
    """Items from a foreign thread all arrive, in order, with the callback on the loop's thread."""
    loop = asyncio.get_running_loop()
    done = loop.create_future()
    seen: list[int] = []
    threads: set[int] = set()

    def read() -> None:
        threads.add(threading.get_ident())
        while inbox.items:
            seen.append(inbox.items.popleft())
        if len(seen) == 1000:
            done.set_result(None)

    bell = Bell(loop)
    inbox = Inbox(bell, None, read)

    def fill() -> None:
        for n in range(1000):
            inbox.put(n)

    thread = threading.Thread(target=fill)
    thread.start()
    await done
    thread.join()
    bell.close()

    assert seen == list(range(1000))
    assert threads == {threading.get_ident()}


async def test_a_closed_bell_is_silent(graphflow_runner: asyncio.Runner) -> None:
    """After `close` nothing wakes the loop, also when it had been rung just before."""
    for threads in (False, True):
        calls: list[int] = []
        bell = Bell(asyncio.get_running_loop(), threads=threads)
        inbox = Inbox(bell, 10, lambda calls=calls: calls.append(1))  # type: ignore[misc]
        inbox.put(0)
        bell.close()
        await settle()
        Inbox(bell, 10, lambda calls=calls: calls.append(2)).put(0)  # type: ignore[misc]
        bell.close()
        await settle()

        assert calls == []


class Arrival(NamedTuple):
    payload: bytes


async def test_a_deep_inbox_is_bounded_by_its_bytes(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The oldest go, a quarter at once; what the loop takes in time is never counted as waiting."""
    monkeypatch.setattr(module, "BYTES_BOUND", 1000)
    inbox = DeepInbox(Bell(asyncio.get_running_loop(), threads=False), 500, lambda: None)
    for n in range(200):
        inbox.put(Arrival(bytes([n]) * 100))
        assert sum(len(item.payload) for item in inbox.items) <= 1000
    assert inbox.items[-1].payload == bytes([199]) * 100
    assert inbox.dropped == 200 - len(inbox.items)
    assert len(inbox.items) >= 7

    inbox.items.clear()
    dropped = inbox.dropped
    for _ in range(200):
        inbox.put(Arrival(bytes(100)))
        inbox.items.popleft()
    assert inbox.dropped == dropped


@pytest.mark.parametrize(("depth", "kind"), [(10, Inbox), (11, WeighedInbox), (100, WeighedInbox), (101, DeepInbox)])
async def test_the_inbox_of_a_depth(graphflow_runner: asyncio.Runner, depth: int, kind: type[Inbox]) -> None:
    """Ten messages are few enough without counting their bytes."""
    made = open_inbox(Qos(depth=depth), Bell(asyncio.get_running_loop(), threads=False), lambda: None)
    assert type(made) is kind


async def test_losses_are_told(graphflow_runner: asyncio.Runner) -> None:
    """The first that counts, and whenever there are twice as many; though nothing is taken."""
    told: list[int] = []
    inbox = Inbox(Bell(asyncio.get_running_loop(), threads=False), 10, lambda: None)
    inbox.tell_losses(lambda: told.append(inbox.dropped), 5)
    for n in range(110):
        inbox.put(n)
        await settle()
    assert told == [5, 10, 20, 40, 80]


async def test_an_inbox_of_requests_refuses_what_comes(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With too many bytes or too many items; it takes again when a quarter has gone."""
    monkeypatch.setattr(module, "BYTES_BOUND", 1000)
    refused: list[Arrival] = []
    told: list[int] = []
    bell = Bell(asyncio.get_running_loop(), threads=False)
    inbox = RequestInbox(bell, 100, lambda: None, size_of, refused.append)
    inbox.tell_losses(lambda: told.append(inbox.dropped), 1)
    for n in range(20):
        inbox.put(Arrival(bytes([n]) * 100))
    assert [item.payload[0] for item in inbox.items] == [*range(10)]
    assert [item.payload[0] for item in refused] == [*range(10, 20)]
    assert inbox.dropped == 10
    await settle()
    assert told == [10]

    inbox.items.popleft()
    inbox.put(Arrival(bytes(100)))
    assert inbox.dropped == 11
    for _ in range(3):
        inbox.items.popleft()
    inbox.put(Arrival(bytes(100)))
    assert inbox.dropped == 11

    inbox.items.clear()
    inbox.put(Arrival(bytes(5000)))  # one that is alone is taken
    inbox.items.clear()
    for _ in range(120):
        inbox.put(Arrival(b""))
    assert len(inbox.items) == 100
    assert inbox.dropped == 31


async def test_what_stands_in_for_the_refused(graphflow_runner: asyncio.Runner) -> None:
    """Waits in its order; there are not endlessly many either."""
    bell = Bell(asyncio.get_running_loop(), threads=False)
    inbox = RequestInbox(bell, 2, lambda: None, size_of, lambda item: "refused")
    for _ in range(30):
        inbox.put(Arrival(b"x"))
    assert [*inbox.items] == [Arrival(b"x"), Arrival(b"x"), *["refused"] * 18]
