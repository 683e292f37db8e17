"""Work outside the event loop that a test waits for: threads, pools and child processes.

Simulated time stands still during such work. asyncio does not list it, so the methods of a loop that start it are
wrapped.
"""

from __future__ import annotations

import asyncio
import functools
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import Executor
from contextlib import suppress
from typing import Any, TypeAlias, TypeVar, TypeVarTuple
from weakref import WeakKeyDictionary

from graphflow.executor.ledger import Ledger
from graphflow.runtime.callables import name_of

T = TypeVar("T")
Ts = TypeVarTuple("Ts")
Start: TypeAlias = Callable[..., Coroutine[object, object, tuple[asyncio.SubprocessTransport, object]]]
"""`loop.subprocess_exec` or `loop.subprocess_shell`."""

_followed: WeakKeyDictionary[asyncio.AbstractEventLoop, Outside] = WeakKeyDictionary()


class Outside:
    """The outside work that one event loop has started."""

    def __init__(self) -> None:
        self.is_awaited = True
        """Whether tests wait for the work."""
        self.ledgers: list[Ledger] = []
        """Ledgers of the loop's node processes, which know the threads of handlers and of `offload`."""
        self._futures: dict[asyncio.Future[Any], str] = {}
        self._processes: list[tuple[asyncio.SubprocessTransport, str]] = []

    def __bool__(self) -> bool:
        return next(self.pending(), None) is not None

    def pending(self) -> Iterator[str]:
        """Describe the work in progress, without threads that themselves wait for the loop."""
        for ledger in self.ledgers:
            for thread in ledger.threads.values():
                if thread.ident not in ledger.asking:
                    yield f"{thread.name.removeprefix('graphflow-')} in a thread"
        yield from self._futures.values()
        for transport, program in self._processes:
            outputs = [transport.get_pipe_transport(fd) for fd in (1, 2)]
            if transport.get_returncode() is None or any(pipe and not pipe.is_closing() for pipe in outputs):
                yield f"the process {program}"

    def follow(self, loop: Any) -> None:
        """Track the work that a loop starts from now on; loops that are not written in Python cannot be tracked."""
        run_in_executor = loop.run_in_executor

        def follow_future(executor: Executor | None, fn: Callable[[*Ts], T], *args: *Ts) -> asyncio.Future[T]:
            future: asyncio.Future[T] = run_in_executor(executor, fn, *args)
            called: object = fn
            while isinstance(called, functools.partial):  # `asyncio.to_thread` passes its function to Context.run
                called = called.args[0] if called.args and callable(called.args[0]) else called.func
            kind = "a thread" if executor is None else type(executor).__name__
            self._futures[future] = f"{name_of(called)} in {kind}"
            future.add_done_callback(self._futures.pop)
            return future

        def follow_processes(start: Start) -> Start:
            @functools.wraps(start)
            async def started(
                factory: object, program: object, *args: object, **options: object
            ) -> tuple[asyncio.SubprocessTransport, object]:
                transport, protocol = await start(factory, program, *args, **options)
                self._processes.append((transport, str(program)))
                return transport, protocol

            return started

        with suppress(AttributeError):
            loop.run_in_executor = follow_future
            loop.subprocess_exec = follow_processes(loop.subprocess_exec)
            loop.subprocess_shell = follow_processes(loop.subprocess_shell)


def outside(loop: asyncio.AbstractEventLoop) -> Outside:
    """Return the outside work of a loop, tracked from the first call on."""
    if loop not in _followed:
        _followed[loop] = Outside()
        _followed[loop].follow(loop)
    return _followed[loop]
