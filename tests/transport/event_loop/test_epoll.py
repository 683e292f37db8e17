"""The event loop that answers bells where its selector sees them."""

from __future__ import annotations

import asyncio
import socket
import sys
import threading
from collections.abc import Callable
from typing import Any

import pytest

from graphflow.system import is_portable
from graphflow.transport.event_loop.loop import run
from graphflow.transport.inbox import Bell, Inbox

epoll: Any = pytest.importorskip(
    "graphflow.transport.event_loop.epoll", reason="only Linux has epoll", exc_type=ImportError
)
BellLoop = epoll.BellLoop
pytestmark = pytest.mark.skipif(is_portable(), reason="the portable way is asyncio's own loop")


async def told(condition: asyncio.Event) -> None:
    async with asyncio.timeout(10.0):
        await condition.wait()


def test_a_bell_is_answered_from_another_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every burst wakes the loop, also one that comes while it is busy; nothing is lost."""
    monkeypatch.setenv("GRAPHFLOW_LOOP", "asyncio")
    seen: list[int] = []

    async def main() -> None:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, BellLoop)
        done = asyncio.Event()
        bell = Bell(loop)

        def ready() -> None:
            while inbox.items:
                seen.append(inbox.items.popleft())
            if len(seen) == 1000:
                done.set()

        inbox = Inbox(bell, None, ready)

        def fill() -> None:
            for i in range(1000):
                inbox.put(i)

        thread = threading.Thread(target=fill)
        thread.start()
        await told(done)
        thread.join()
        bell.close()

    run(main())
    assert seen == list(range(1000))


def test_a_bell_takes_the_short_way() -> None:
    """On the loop that has a short way for bells they take it: asyncio's readers stay out of it."""
    loop = BellLoop()
    readers: list[object] = []
    loop.add_reader = lambda fd, *_: readers.append(fd)
    bell = Bell(loop)
    calls: list[int] = []

    def ready() -> None:
        calls.append(len(inbox.items))
        loop.stop()

    inbox = Inbox(bell, None, ready)
    inbox.put("news")
    loop.call_later(10.0, loop.stop)
    loop.run_forever()
    bell.close()
    loop.close()
    assert calls == [1]
    assert readers == []


def test_everything_else_works_as_on_asyncios_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """Timers, sockets that are read and written, threads and subprocesses, beside a bell that rings all the time."""
    monkeypatch.setenv("GRAPHFLOW_LOOP", "asyncio")

    async def main() -> None:
        loop = asyncio.get_running_loop()
        bell, rings = Bell(loop), 0

        def ready() -> None:
            nonlocal rings
            rings += 1
            inbox.items.clear()
            loop.call_later(0.001, inbox.put, 1)

        inbox = Inbox(bell, 1, ready)
        inbox.put(1)
        ours, theirs = socket.socketpair()
        reader, writer = await asyncio.open_connection(sock=ours)
        _, other = await asyncio.open_connection(sock=theirs)
        payload = bytes(10_000_000)
        other.write(payload)
        assert await asyncio.wait_for(reader.readexactly(len(payload)), 10.0) == payload
        began = loop.time()
        await asyncio.sleep(0.02)
        assert loop.time() - began >= 0.019
        assert await asyncio.to_thread(lambda: 3) == 3
        child = await asyncio.create_subprocess_exec(sys.executable, "-c", "print(7)", stdout=asyncio.subprocess.PIPE)
        out, _ = await asyncio.wait_for(child.communicate(), 20.0)
        assert out == b"7\n"
        assert rings > 2
        writer.close()
        other.close()
        bell.close()

    run(main())


def test_an_error_of_one_inbox_is_not_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """It goes to the loop's exception handler; the others are attended to."""
    monkeypatch.setenv("GRAPHFLOW_LOOP", "asyncio")
    told_of: list[BaseException | None] = []

    async def main() -> None:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: told_of.append(context.get("exception")))
        bell, done = Bell(loop), asyncio.Event()

        def fail() -> None:
            raise ValueError("no")

        wrong, right = Inbox(bell, 1, fail), Inbox(bell, 1, done.set)
        for inbox in (wrong, right):
            threading.Thread(target=inbox.put, args=(1,)).start()
        await told(done)
        bell.close()

    run(main())
    assert [str(error) for error in told_of] == ["no"]


async def _in_a_thread(fn: Callable[[], object]) -> None:
    thread = threading.Thread(target=fn)
    thread.start()
    await asyncio.to_thread(thread.join)


def test_call_soon_of_another_thread() -> None:
    """Is told in that thread; the loop's own calls, those of `call_soon_threadsafe` and of a loop at rest are not."""
    told, called = list[int](), list[int]()

    async def main() -> None:
        loop: Any = asyncio.get_running_loop()
        loop.stranger = lambda: told.append(threading.get_ident())
        loop.call_soon(called.append, 1)
        await _in_a_thread(lambda: loop.call_soon_threadsafe(called.append, 2))
        assert told == []
        await _in_a_thread(lambda: loop.call_soon(called.append, 3))
        await asyncio.sleep(0)

    loop = BellLoop()
    loop.call_soon(called.append, 0)
    loop.run_until_complete(main())
    loop.close()
    assert called == [0, 1, 2, 3]
    assert len(told) == 1
    assert told != [threading.get_ident()]
    with pytest.raises(RuntimeError, match="closed"):
        loop.call_soon(print)


def test_call_soon_in_debug_mode() -> None:
    """Is asyncio's own: it refuses other threads."""

    async def main() -> None:
        loop = asyncio.get_running_loop()
        with pytest.raises(RuntimeError, match="Non-thread-safe"):
            await asyncio.to_thread(loop.call_soon, print)

    loop = BellLoop()
    loop.set_debug(True)
    loop.run_until_complete(main())
    loop.run_until_complete(loop.shutdown_default_executor())
    loop.close()
