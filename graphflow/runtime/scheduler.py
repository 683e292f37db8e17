"""How handlers run: activities, stepped straight from the arrival that caused them, under concurrency groups.

An `Activity` is one run of a handler. It is a minimal asyncio task: the loop never hears of it unless the handler
suspends, which saves a turn of the loop per message, and yet `asyncio.timeout`, `TaskGroup`, `current_task` and
the rest work inside it from its first line (asyncio documents `_enter_task` and `_leave_task` for such tasks).

A `Runner` feeds the items of one queue to one handler, a run at a time or as many as the group allows.
"""

from __future__ import annotations

import asyncio
import itertools
from asyncio import AbstractEventLoop, CancelledError
from asyncio.tasks import _enter_task, _leave_task
from collections import deque
from collections.abc import Callable, Coroutine
from contextvars import Context, copy_context
from inspect import iscoroutine
from types import CoroutineType
from typing import Any

from graphflow.runtime.groups import HandlerGroup

BURST = 64
"""Runs of one handler in a row before the loop gets a turn."""


_next_number = itertools.count(1).__next__


class Activity:
    """One run of a coroutine, with the part of `asyncio.Task`'s face that asyncio's own tools use.

    Args:
        finished: Called once with (result, error) when the coroutine has ended, its `finally` blocks included.
        context: Its context variables, for itself alone; without one, a copy of the caller's.
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
        """Whose slot it holds."""
        self.returning_to: HandlerGroup | None = None
        """The group that it waits to come back to."""

    def __repr__(self) -> str:
        return f"<Activity {self.name}{' done' if self.done() else ''}>"

    def start(self) -> None:
        """Run to the first suspension. Not from inside another task."""
        self._context.run(self.step)

    def step(self, error: BaseException | None = None) -> None:
        """Go on to the next suspension. For the loop; within the activity's context."""
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
        except (KeyboardInterrupt, SystemExit) as exit_:
            _leave_task(loop, self)  # type: ignore[arg-type]
            self._end(None, exit_)
            raise
        except BaseException as raised:
            result, failure = None, raised
        else:
            _leave_task(loop, self)  # type: ignore[arg-type]
            self._wait_for(awaited)
            return
        _leave_task(loop, self)  # type: ignore[arg-type]
        self._end(result, failure)
        error = failure = None  # their tracebacks know this frame: no circle for the garbage collector

    def _wait_for(self, awaited: Any) -> None:
        blocking = getattr(awaited, "_asyncio_future_blocking", None)
        if awaited is None:
            self._loop.call_soon(self.step, context=self._context)
        elif blocking and awaited.get_loop() is not self._loop:
            wrong = RuntimeError(f"{self.name} awaited {awaited!r}, which belongs to another event loop")
            self._loop.call_soon(self.step, wrong, context=self._context)
        elif blocking:
            awaited._asyncio_future_blocking = False
            awaited.add_done_callback(self._wakeup, context=self._context)
            self._fut_waiter = awaited
            if self._must_cancel and awaited.cancel(msg=self._cancel_message):
                self._must_cancel = False
        else:
            wrong = RuntimeError(f"{self.name} awaited {awaited!r}, which is nothing asyncio knows")
            self._loop.call_soon(self.step, wrong, context=self._context)

    def _wakeup(self, future: asyncio.Future[Any]) -> None:
        try:
            future.result()
        except BaseException as error:
            self.step(error)
        else:
            self.step()

    def _end(self, result: Any, error: BaseException | None) -> None:
        self._coroutine = None
        finished = self._finished
        del self._finished  # it may know this activity: likewise
        finished(result, error)

    def _cancelled(self) -> CancelledError:
        return CancelledError() if self._cancel_message is None else CancelledError(self._cancel_message)

    # What asyncio.timeout, TaskGroup and their like ask of the current task.

    def cancel(self, msg: Any = None) -> bool:
        """Raise CancelledError in the coroutine at its next step; False when it has ended."""
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


class Run(Activity):
    """An activity of a `Runner`, which it tells of its end. One is made for every message.

    Attributes:
        item: What it was begun for.
        number: Rises from run to run through the whole process, and is never used twice.
    """

    __slots__ = ("item", "number", "runner")

    def __init__(
        self,
        runner: Runner,
        item: Any,
        coroutine: Coroutine[Any, Any, Any],
        context: Context,
        group: HandlerGroup | None,
    ) -> None:
        # Written out: to call the constructor above would take a tenth of a run.
        self.name = runner.name
        self._loop = runner._loop
        self._coroutine = coroutine
        self._context = context
        self._fut_waiter = None
        self._must_cancel = False
        self._cancel_message = None
        self._cancel_requests = 0
        self.group = group
        self.returning_to = None
        self.runner, self.item = runner, item
        self.number = _next_number()

    def _end(self, result: Any, error: BaseException | None) -> None:
        self._coroutine = None
        item = self.item
        del self.item  # a message is free when its run has ended
        runner = self.runner
        runner.active.discard(self)
        runner._ended(self.group, item, result, error)


def _nothing() -> None:
    """Nobody wants to know."""


Finished = Callable[[Any, Any, BaseException | None], None]


class Runner:
    """Feeds a queue to a handler under a group.

    Args:
        name: For messages: node, handler.
        group: Whose slots the runs take; None for a runner that queues behind itself only.
        items: The queue, filled by somebody else, who then calls `wake`.
        invoke: Called with an item; returns a result, or a coroutine that will.
        finished: Called with (item, result, error) after each run.
        refused: Called with an item that is dropped because the group is full.
        kind: For people, as in `service`.
    """

    __slots__ = (
        "_closed",
        "_context",
        "_finished",
        "_idle",
        "_invoke",
        "_loop",
        "_refused",
        "_scheduled",
        "_waking",
        "active",
        "dropped",
        "errors",
        "group",
        "handler",
        "is_inner",
        "items",
        "kind",
        "name",
        "number",
        "one_at_a_time",
        "runs",
        "stalled",
    )

    def __init__(
        self,
        loop: AbstractEventLoop,
        name: str,
        group: HandlerGroup | None,
        items: deque[Any],
        invoke: Callable[[Any], Any],
        finished: Finished,
        refused: Callable[[Any], None] | None = None,
        *,
        kind: str = "",
    ) -> None:
        self.name = name
        self.kind = kind
        """What it runs for: timer, subscription, service, action."""
        self.handler = name.rpartition(".")[2]
        """The method."""
        self.is_inner = False
        """Whether it belongs to graphflow, as every node's parameter services do."""
        self.number = _next_number()
        self.dropped: Callable[[], int] = int
        """Items lost because the queue was full."""
        self.stalled: Callable[[], None] = _nothing
        """Called when there is work and no slot for it."""
        self.items = items
        self.runs = 0
        """Runs begun since the start."""
        self.errors = 0
        """Runs that ended with an error."""
        self.group = group
        self.one_at_a_time: bool | None = None
        """Whether its runs exclude each other whatever group they run in; None: when they run in none."""
        self.active: set[Run] = set()
        """Runs that have begun and not ended."""
        self._loop = loop
        self._invoke, self._finished, self._refused = invoke, finished, refused
        # Every run begins with the variables of where the handler was made, never with those of an earlier run.
        self._context = copy_context()
        self._waking = False
        self._scheduled = False
        self._closed = False
        self._idle: asyncio.Future[None] | None = None
        if group is not None:
            group.members.append(self)

    def __repr__(self) -> str:
        return f"<Runner {self.name}>"

    @property
    def label(self) -> str:
        """Handler and kind, for people: `service add`."""
        return self.handler if self.handler.startswith(f"{self.kind} ") else f"{self.kind} {self.handler}".strip()

    @property
    def is_serial(self) -> bool:
        """Whether its runs come one after the other."""
        return self.group is None if self.one_at_a_time is None else self.one_at_a_time

    @property
    def closed(self) -> bool:
        """Whether `cancel` has been called."""
        return self._closed

    def wake(self) -> None:
        """There may be something in the queue: run what the group allows."""
        if self._waking or self._closed or self._scheduled:
            return
        group, active, items = self.group, self.active, self.items
        self._waking = True
        try:
            for _ in range(BURST):
                if not items or self._closed:
                    return
                if active and (group is None if self.one_at_a_time is None else self.one_at_a_time):
                    self.stalled()
                    return
                # Nobody asks for more slots than the group has: who runs queues again, at the tail, after the run.
                if group is not None and (self._fills(group) or not group.admit(self)):
                    if group.when_full != "wait" and self.kind != "reply":
                        self._overflow(group)
                    self.stalled()
                    return
                self.runs += 1
                context = self._context.copy()
                context.run(self._begin, items.popleft(), context, group)
                group = self.group  # the handler may have moved itself
        finally:
            self._waking = False
        if self.items:
            self._scheduled = True
            self._loop.call_soon(self._go_on)

    def _fills(self, group: HandlerGroup) -> bool:
        """Whether its own runs hold all slots of the group; those that have let go of theirs do not count."""
        if group.limit is None or len(self.active) < group.limit:
            return False
        return sum(run.group is group for run in self.active) >= group.limit

    def _go_on(self) -> None:
        self._scheduled = False
        self.wake()

    def _overflow(self, group: HandlerGroup) -> None:
        """The group is full, and not everything is to wait for it."""
        if group.when_full == "drop_new":
            group.withdraw(self)
            self._refuse(0)
            return
        self._refuse(1)
        for other in group.waiting:
            if other is not self:
                other.yields()
        group.admit(self)
        if group.when_full == "cancel_running":
            members = [member for member in group.members if isinstance(member, Runner)]
            runs = [run for member in members for run in member.active if run.group is group]
            if runs and not any(run.cancelling() for run in runs):
                min(runs, key=lambda run: run.number).cancel("cancelled for newer work of its group")

    def _refuse(self, keep: int) -> None:
        """Drop what waits, but for the newest."""
        while len(self.items) > keep:
            item = self.items.popleft()
            if self._refused is not None:
                self._refused(item)

    def yields(self) -> None:
        if self.kind == "reply":  # somebody waits for it
            return
        if self.group is not None:
            self.group.withdraw(self)
        self._refuse(0)

    def granted(self, group: HandlerGroup) -> None:
        may_run = not self._closed and group is self.group and not (self.one_at_a_time and self.active)
        if self.items and may_run:
            self.runs += 1
            context = self._context.copy()
            context.run(self._begin, self.items.popleft(), context, group)
        else:
            group.give_back(self._loop)
        self.wake()

    def move(self, group: HandlerGroup | None) -> None:
        """Take the slots of another group from the next run on; runs under way keep what they hold."""
        if self.group is not None:
            self.group.withdraw(self)
            self.group.members.remove(self)
        self.group = group
        if group is not None:
            group.members.append(self)
        self._loop.call_soon(self.wake)

    def _begin(self, item: Any, context: Context, group: HandlerGroup | None) -> None:
        """Run the handler, within its context, to its end or to its first suspension."""
        try:
            result = self._invoke(item)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:
            self._ended(group, item, None, error)
            return
        if result.__class__ is not CoroutineType and not iscoroutine(result):
            self._ended(group, item, result, None)
            return
        run = Run(self, item, result, context, group)
        self.active.add(run)
        run.step()

    def _ended(self, group: HandlerGroup | None, item: Any, result: Any, error: BaseException | None) -> None:
        if error is not None and not isinstance(error, CancelledError):
            self.errors += 1
        try:
            self._finished(item, result, error)
        except Exception as failure:
            message = f"{self.name}: the end of a run could not be reported"
            self._loop.call_exception_handler({"message": message, "exception": failure})
        if group is not None:
            group.give_back(self._loop)
        if self._idle is not None:
            self._look_idle()
        if self.items and not self._waking:
            self.wake()

    def cancel(self) -> asyncio.Future[None]:
        """Begin no more runs and cancel those under way, but for those that clean up after having been cancelled.

        Returns:
            A future that is done when all have ended.
        """
        if not self._closed and self.group is not None:
            self.group.withdraw(self)
            self.group.members.remove(self)
        self._closed = True
        if self._idle is None:
            self._idle = self._loop.create_future()
        for run in list(self.active):
            if not run.cancelling():
                run.cancel()
        self._look_idle()
        return self._idle

    def _look_idle(self) -> None:
        if self._idle is not None and not self.active and not self._idle.done():
            self._idle.set_result(None)
