"""An event loop on a thread of its own, for processes whose other threads run the callbacks.

Other threads use graphflow's objects through `call` and `wait`, which block until the answer. The loop's thread
never runs user code, so it never blocks on any.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import threading
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

from graphflow.transport.config import before_closing_at_exit
from graphflow.transport.event_loop.loop import new_event_loop
from graphflow.transport.malloc import keep_freed_memory

T = TypeVar("T")

STOP_LIMIT = 2.0
"""Seconds that the loop may take to stop when the process ends."""


class LoopThread:
    """An event loop on a thread of its own that ends with the process."""

    def __init__(self) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()
        self.at_exit: list[Callable[[], None]] = []
        """Callbacks that run, last registered first, before the loop stops."""

    def start(self) -> asyncio.AbstractEventLoop:
        """Return the loop, starting it if necessary."""
        with self._lock:
            if self._loop is None:
                keep_freed_memory()
                self._loop = new_event_loop()
                self._thread = threading.Thread(
                    target=self._run, args=(self._loop,), name="graphflow-loop", daemon=True
                )
                self._thread.start()
                before_closing_at_exit(self._stop)
            return self._loop

    @staticmethod
    def _run(loop: asyncio.AbstractEventLoop) -> None:
        asyncio.set_event_loop(loop)
        loop.run_forever()
        loop.close()

    @property
    def is_here(self) -> bool:
        """Whether this is the loop's thread."""
        return threading.current_thread() is self._thread

    def call(self, fn: Callable[..., T], *args: Any) -> T:
        """Call `fn(*args)` on the loop, and block until it returns or raises."""
        loop = self.start()
        # It would wait for itself.
        if self.is_here:
            return fn(*args)
        outcome: concurrent.futures.Future[T] = concurrent.futures.Future()

        def work() -> None:
            try:
                outcome.set_result(fn(*args))
            except BaseException as error:  # whatever it is, the caller handles it in its own thread
                outcome.set_exception(error)

        loop.call_soon_threadsafe(work)
        return outcome.result()

    def wait(self, fn: Callable[..., Coroutine[object, object, T]], *args: Any, timeout: float | None = None) -> T:
        """Run the coroutine `fn(*args)` on the loop, and block until it returns or raises.

        Raises:
            TimeoutError: It took more than `timeout` seconds and was cancelled.
        """
        loop = self.start()
        # The coroutine is made on the loop: Ctrl-C here would lose it before it runs, and Python would warn of that.
        asked = self.call(lambda: asyncio.run_coroutine_threadsafe(fn(*args), loop))
        try:
            return asked.result(timeout)
        except TimeoutError:
            asked.cancel()
            raise

    def soon(self, fn: Callable[..., object], *args: Any) -> None:
        """Schedule `fn(*args)` on the loop, unless it has ended. Callable from any thread."""
        loop = self._loop
        if loop is not None and not loop.is_closed():
            loop.call_soon_threadsafe(fn, *args)

    def _stop(self) -> None:
        """Stop the loop when the process ends."""
        while self.at_exit:
            self.at_exit.pop()()
        loop, thread = self._loop, self._thread
        if loop is not None and thread is not None and not loop.is_closed():
            loop.call_soon_threadsafe(loop.stop)
            thread.join(STOP_LIMIT)
