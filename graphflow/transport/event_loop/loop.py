"""The event loop that nodes run on: uvloop's if the extra `fast` is installed, else asyncio's."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import closing, suppress
from importlib.util import find_spec
from typing import Any, TypeVar

from graphflow.system import chosen_loop, collect_normally, is_portable
from graphflow.transport.event_loop.daemon_threads import THREADS, DaemonExecutor
from graphflow.transport.malloc import keep_freed_memory

T = TypeVar("T")


def new_event_loop() -> asyncio.AbstractEventLoop:
    """Return an event loop of the best kind available. Closing it does not wait for `asyncio.to_thread`."""
    loop = _loop_of_the_best_kind()
    loop.set_default_executor(DaemonExecutor())
    return loop


def _loop_of_the_best_kind() -> asyncio.AbstractEventLoop:
    chosen = chosen_loop()
    if chosen == "uvloop" or (not chosen and find_spec("uvloop") is not None):
        import uvloop

        loop: asyncio.AbstractEventLoop = uvloop.new_event_loop()
        return loop
    if is_portable():
        return asyncio.new_event_loop()
    from graphflow.transport.event_loop.epoll import BellLoop

    return BellLoop()


def run(main: Coroutine[Any, Any, T]) -> T:
    """Run a coroutine as `asyncio.run`, on the best loop available, in a process tuned for large messages."""
    # If no loop can be made, or Ctrl-C comes before, `main` is never awaited, of which Python would warn.
    with closing(main):
        keep_freed_memory()
        collect_normally()
        with asyncio.Runner(loop_factory=new_event_loop) as runner:
            return runner.run(main)


async def in_thread(fn: Callable[[], object]) -> None:
    """Run `fn()` in a thread and wait for its end, even during the interpreter's exit, when pools do not work."""
    loop = asyncio.get_running_loop()
    ended: asyncio.Future[None] = loop.create_future()

    def done(_: object, error: BaseException | None) -> None:
        with suppress(RuntimeError):  # the loop has been closed in the meantime
            loop.call_soon_threadsafe(_settle, ended, error)

    THREADS.run(fn, done, f"graphflow-{getattr(fn, '__name__', 'thread')}")
    await ended


def _settle(future: asyncio.Future[None], error: BaseException | None) -> None:
    if future.done():
        return
    if error is not None:
        future.set_exception(error)
    else:
        future.set_result(None)
