"""Activities: each is one run of a handler, stepped directly from the arrival that caused it.

It is a minimal asyncio task. The loop is not involved unless the handler suspends, which saves a loop iteration per
message; still, `asyncio.timeout`, `TaskGroup`, `current_task` and others work inside it from its first line (asyncio
documents `_enter_task` and `_leave_task` for such tasks).
"""

from __future__ import annotations

import asyncio
from asyncio import AbstractEventLoop, CancelledError
from asyncio.tasks import _enter_task, _leave_task
from collections.abc import Callable, Coroutine
from contextvars import Context, copy_context
from typing import Any

from graphflow.executor.groups import HandlerGroup


class Activity:
    """One run of a coroutine, with the part of `asyncio.Task`'s interface that asyncio's own tools use.

    Args:
        finished: Called once with (result, error) when the coroutine has ended, including its `finally` blocks.
        context: Its own context variables; by default a copy of the caller's.

    Attributes:
        suspended_at: Start of its wait for a future, in the loop's time; only valid during the wait.
    """

    __slots__ = (
        "__weakref__",
        "_cancel_message",
        "_cancel_requests",
        "_context",
        "_coroutine",
        "_finished",
        "_fut_waiter",
        "_loop",
        "_must_cancel",
        "group",
        "name",
        "returning_to",
        "suspended_at",
    )

    def __init__(
        self,
        loop: AbstractEventLoop,
        coroutine: Coroutine[Any, Any, Any],
        name: str,
        finished: Callable[[Any, BaseException | None], None],
        context: Context | None = None,
    ) -> None:
        self.name = name
        self._loop = loop
        self._coroutine: Coroutine[Any, Any, Any] | None = coroutine
        self._finished = finished
        self._context: Context = copy_context() if context is None else context
        self._fut_waiter: Any = None
        self._must_cancel = False
        self._cancel_message: Any = None
        self._cancel_requests = 0
        self.group: HandlerGroup | None = None
        """The group in which the activity has a slot."""
        self.returning_to: HandlerGroup | None = None
        """The group to which the activity waits to return."""

    def __repr__(self) -> str:
        return f"<Activity {self.name}{' done' if self.done() else ''}>"

    def start(self) -> None:
        """Run to the first suspension. Must not be called inside another task."""
        self._context.run(self.step)

    def step(self, error: BaseException | None = None) -> None:
        """Run to the next suspension. Called by the loop, within the activity's context."""
        coroutine = self._coroutine
        if coroutine is None:
            return
        if self._must_cancel:
            if not isinstance(error, CancelledError):
                error = self._cancelled()
            self._must_cancel = False
        self._fut_waiter = None
        loop = self._loop
        _enter_task(loop, self)  # type: ignore[arg-type]
        try:
            awaited = coroutine.send(None) if error is None else coroutine.throw(error)
        except StopIteration as stop:
            result, failure = stop.value, None
        # These end the loop itself, as from an asyncio.Task.
        except (KeyboardInterrupt, SystemExit) as exit_:
            _leave_task(loop, self)  # type: ignore[arg-type]
            self._end(None, exit_)
            raise
        except BaseException as raised:  # any end of the coroutine, cancellation included, is passed to `finished`
            result, failure = None, raised
        else:
            _leave_task(loop, self)  # type: ignore[arg-type]
            self._wait_for(awaited)
            return
        _leave_task(loop, self)  # type: ignore[arg-type]
        self._end(result, failure)
        error = failure = None  # their tracebacks refer to this frame: avoid a reference cycle

    def _wait_for(self, awaited: Any) -> None:
        blocking = getattr(awaited, "_asyncio_future_blocking", None)
        # A bare `yield`, as in `asyncio.sleep(0)`: the next step is due in the loop's next iteration.
        if awaited is None:
            self._loop.call_soon(self.step, context=self._context)
        elif blocking and awaited.get_loop() is not self._loop:
            wrong = RuntimeError(f"{self.name} awaited {awaited!r}, which belongs to another event loop")
            self._loop.call_soon(self.step, wrong, context=self._context)
        elif blocking:
            # Tells the future that it is awaited, and not yielded by mistake (asyncio.Task's protocol).
            awaited._asyncio_future_blocking = False
            awaited.add_done_callback(self._wakeup, context=self._context)
            self.suspended_at = self._loop.time()
            self._fut_waiter = awaited
            # The coroutine was cancelled, perhaps by itself, while it ran.
            if self._must_cancel and awaited.cancel(msg=self._cancel_message):
                self._must_cancel = False
        else:
            wrong = RuntimeError(f"{self.name} awaited {awaited!r}, which asyncio cannot await")
            self._loop.call_soon(self.step, wrong, context=self._context)

    def _wakeup(self, future: asyncio.Future[Any]) -> None:
        try:
            future.result()
        except BaseException as error:  # whatever the future failed with is raised in the coroutine
            self.step(error)
        else:
            self.step()

    def _end(self, result: Any, error: BaseException | None) -> None:
        self._coroutine = None
        finished = self._finished
        del self._finished  # it may refer to this activity: avoid a reference cycle
        finished(result, error)

    def _cancelled(self) -> CancelledError:
        return CancelledError() if self._cancel_message is None else CancelledError(self._cancel_message)

    # The interface that asyncio.timeout, TaskGroup and others use of the current task.

    def cancel(self, msg: Any = None) -> bool:
        """Raise CancelledError in the coroutine at its next step; returns False if it has ended."""
        if self._coroutine is None:
            return False
        self._cancel_requests += 1
        if self._fut_waiter is not None and self._fut_waiter.cancel(msg=msg):
            return True
        self._must_cancel = True
        self._cancel_message = msg
        return True

    def cancelling(self) -> int:
        return self._cancel_requests

    def uncancel(self) -> int:
        if self._cancel_requests:
            self._cancel_requests -= 1
            if not self._cancel_requests:
                # As asyncio.Task does since 3.13: a cancellation that was not delivered yet is withdrawn.
                self._must_cancel = False
        return self._cancel_requests

    def done(self) -> bool:
        return self._coroutine is None

    def get_name(self) -> str:
        return self.name

    def get_coro(self) -> Coroutine[Any, Any, Any] | None:
        return self._coroutine

    def get_context(self) -> Context:
        return self._context

    def get_loop(self) -> AbstractEventLoop:
        return self._loop
