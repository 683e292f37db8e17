"""Runners: each passes the items of a queue to one handler, as many at a time as its group allows."""

from __future__ import annotations

import asyncio
import itertools
from asyncio import CancelledError
from asyncio.tasks import _enter_task, _leave_task
from collections import deque
from collections.abc import Callable, Coroutine
from contextvars import Context, copy_context
from dataclasses import dataclass
from inspect import iscoroutine
from sys import getrefcount
from time import monotonic
from types import CoroutineType
from typing import Any, Literal
from weakref import getweakrefcount

from graphflow.executor.activity import Activity
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.ledger import Ledger

BURST = 64
"""Successive runs of one handler before the loop gets a turn."""
SLICE = 0.003
"""Seconds after which a burst ends, since timers, other handlers and Ctrl-C have waited that long."""


def _references_of_one() -> int:
    """Return `getrefcount` of an object with a single local reference, which depends on the interpreter."""
    alone = object()
    return getrefcount(alone)


_ALONE = _references_of_one()
_next_number = itertools.count(1).__next__

RunnerKind = Literal["", "timer", "subscription", "service", "action", "reply"]
"""The purpose of a runner's runs; `reply` delivers responses to a client in a group, and is never dropped."""


class Run(Activity):
    """An activity of a `Runner`, to which it reports its end. One per message.

    Attributes:
        item: The item that the run handles.
        number: An increasing number, unique in the process.
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
        # Inlined: calling the constructor above would take a tenth of a run.
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
        del self.item  # a message is freed when its run has ended
        runner = self.runner
        runner.active.discard(self)
        runner._ended(self.group, item, result, error)


def title_of(kind: RunnerKind, handler: str) -> str:
    """Return kind and handler for people: `service add`."""
    return handler if handler.startswith(f"{kind} ") else f"{kind} {handler}".strip()


Finished = Callable[[Any, Any, BaseException | None], None]


@dataclass(frozen=True, slots=True)
class RunnerSpec:
    """The handler of a runner, and the callbacks for its outcomes.

    Attributes:
        handler: The method's name, or its substitute in messages.
        invoke: Called with an item; returns a result, or a coroutine for it.
        finished: Called with (item, result, error) after each run.
        node: The full name of the node.
        refused: Called with an item that is dropped because the group is full.
        dropped: Returns the number of items lost to a full queue.
        is_inner: Whether the handler belongs to graphflow, as those of parameter services do.
        is_serial: Whether its runs exclude each other in any group; None if only outside of a group.
        wants_results: Whether `finished` is also called after successful runs.
        begins_outside: Whether `invoke` only creates a coroutine, so that it may be called outside the run's context.
    """

    handler: str
    invoke: Callable[[Any], Any]
    finished: Finished
    node: str = ""
    kind: RunnerKind = ""
    refused: Callable[[Any], None] | None = None
    dropped: Callable[[], int] = int
    is_inner: bool = False
    is_serial: bool | None = None
    wants_results: bool = True
    begins_outside: bool = False


class Runner:
    """The queue of a handler, run under a group.

    Args:
        items: The queue, filled by other code, which then calls `wake`.
        group: The group whose slots the runs take; None for a runner that only queues behind itself.
    """

    __slots__ = (
        "_begins_outside",
        "_closed",
        "_context",
        "_finished",
        "_idle",
        "_invoke",
        "_is_serial",
        "_ledger",
        "_loop",
        "_scheduled",
        "_spare",
        "_waking",
        "_wants_results",
        "active",
        "at_hand",
        "errors",
        "group",
        "items",
        "name",
        "number",
        "runs",
        "spec",
    )

    def __init__(self, ledger: Ledger, spec: RunnerSpec, items: deque[Any], group: HandlerGroup | None = None) -> None:
        self.spec = spec
        self.name = f"{spec.node}.{spec.handler}" if spec.node else spec.handler
        """The name used in messages."""
        self.number = _next_number()
        self.items = items
        self.at_hand: Any = None
        """The item whose handler was called and has not returned or suspended."""
        self.runs = 0
        """Runs started so far."""
        self.errors = 0
        """Runs that ended with an error."""
        self.group = group
        self.active: set[Run] = set()
        """Runs that have started and not ended."""
        self._ledger, self._loop = ledger, ledger.loop
        # Copies of the spec's fields that every run needs.
        self._invoke, self._finished, self._is_serial = spec.invoke, spec.finished, spec.is_serial
        self._wants_results, self._begins_outside = spec.wants_results, spec.begins_outside
        self._spare: Run | None = None
        """A run that ended in its first step and that nothing refers to, for reuse by the next message."""
        # Every run starts with the context variables of the handler's creation, never with those of an earlier run.
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
    def title(self) -> str:
        """Kind and handler for people: `service add`."""
        return title_of(self.spec.kind, self.spec.handler)

    @property
    def is_serial(self) -> bool:
        """Whether the handler's runs exclude each other."""
        return self.group is None if self._is_serial is None else self._is_serial

    @property
    def closed(self) -> bool:
        """Whether `cancel` has been called."""
        return self._closed

    def stalled(self) -> None:
        """Report that there is work and no slot for it."""
        self._ledger.alert()

    def wake(self) -> None:
        """Start the runs that the group allows for the items in the queue."""
        if not (self._waking or self._closed or self._scheduled):
            self._run(BURST)

    def _run(self, most: int, granted: HandlerGroup | None = None) -> None:
        """Run the handler for one item after another, each to its end or its first suspension.

        Every message takes this path. It is a single long function because each call in it would add a twentieth to a
        message's time.

        Args:
            most: The most runs to start.
            granted: The group that has granted a slot for the first run.
        """
        loop, ledger, items, active = self._loop, self._ledger, self.items, self.active
        invoke, copy, begins_outside = self._invoke, self._context.copy, self._begins_outside
        was_waking, self._waking = self._waking, True
        around, ledger.at_work = ledger.at_work, self
        group: HandlerGroup | None
        until = monotonic() + SLICE
        try:
            for begun in range(most):
                if granted is not None:
                    group, granted = granted, None
                elif not items or self._closed:
                    return
                elif begun and monotonic() > until:
                    break
                else:
                    group = self.group  # the handler may have moved itself
                    if active and (group is None if self._is_serial is None else self._is_serial):
                        ledger.alert()
                        return
                    # No runner requests more slots than the group has: after a run it queues again, at the tail.
                    if group is not None and (self._fills(group) or not group.admit(self)):
                        if group.when_full != "wait" and self.spec.kind != "reply":
                            self._overflow(group)
                        ledger.alert()
                        return
                self.runs += 1
                self.at_hand = item = items.popleft()
                context = copy()  # each run has its own
                run: Run | None = None
                error: BaseException | None = None
                try:
                    result = invoke(item) if begins_outside else context.run(invoke, item)
                    if result is not None and (result.__class__ is CoroutineType or iscoroutine(result)):
                        run = self._spare
                        if run is None:
                            run = Run(self, item, result, context, group)
                        else:
                            self._spare = None
                            run._coroutine, run._context, run.item, run.group = result, context, item, group
                            run.number = _next_number()
                        active.add(run)
                        # As `Activity.step`, without the cases that cannot occur before the first step.
                        _enter_task(loop, run)  # type: ignore[arg-type]
                        try:
                            awaited = context.run(result.send, None)
                        finally:
                            _leave_task(loop, run)  # type: ignore[arg-type]
                        run._wait_for(awaited)
                        continue
                except StopIteration as stop:
                    if run is None:
                        result, error = None, stop
                    else:
                        result = stop.value
                except (KeyboardInterrupt, SystemExit) as exit_:
                    if run is not None:
                        run._end(None, exit_)
                    raise
                except BaseException as raised:  # the handler's end, cancellation included, goes to `finished`
                    result, error = None, raised
                if run is not None:
                    group = run.group
                    active.discard(run)
                    run._coroutine = run.item = None
                    if getrefcount(run) == _ALONE and not run._cancel_requests and not getweakrefcount(run):
                        self._spare = run
                if error is not None or self._wants_results or group is not None or self._idle is not None:
                    self._ended(group, item, result, error)
                    error = None  # its traceback refers to this frame: avoid a reference cycle
        finally:
            self._waking = was_waking
            ledger.at_work, self.at_hand = around, None
        if items and not was_waking and not self._scheduled:
            self._scheduled = True
            loop.call_soon(self._go_on)

    def _fills(self, group: HandlerGroup) -> bool:
        """Whether the runner's own runs occupy all slots of the group, not counting those that have released theirs."""
        if group.limit is None or len(self.active) < group.limit:
            return False
        return sum(run.group is group for run in self.active) >= group.limit

    def _go_on(self) -> None:
        self._scheduled = False
        self.wake()

    def _overflow(self, group: HandlerGroup) -> None:
        """Apply the group's policy to queued work while the group is full."""
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
            # A run that is being cancelled frees a slot by itself: the next newer item must not cancel another one.
            if runs and not any(run.cancelling() for run in runs):
                min(runs, key=lambda run: run.number).cancel("cancelled for newer work of its group")

    def _refuse(self, keep: int) -> None:
        """Drop queued items, except the newest `keep`."""
        while len(self.items) > keep:
            item = self.items.popleft()
            if self.spec.refused is not None:
                self.spec.refused(item)

    def yields(self) -> None:
        if self.spec.kind == "reply":  # a caller waits for it
            return
        if self.group is not None:
            self.group.withdraw(self)
        self._refuse(0)

    def granted(self, group: HandlerGroup) -> None:
        may_run = not self._closed and group is self.group and not (self._is_serial and self.active)
        if self.items and may_run:
            self._run(1 if self._waking or self._scheduled else BURST, group)
        else:
            # The work has gone, or the runner has moved or closed since it queued: the next member gets the slot.
            group.give_back(self._loop)
            self.wake()

    def move(self, group: HandlerGroup | None) -> None:
        """Use another group from the next run on; runs in progress keep their slots."""
        if self.group is not None:
            self.group.withdraw(self)
            self.group.members.remove(self)
        self.group = group
        if group is not None:
            group.members.append(self)
        self._loop.call_soon(self.wake)

    def _ended(self, group: HandlerGroup | None, item: Any, result: Any, error: BaseException | None) -> None:
        if error is not None and not isinstance(error, CancelledError):
            self.errors += 1
        if error is not None or self._wants_results:
            try:
                self._finished(item, result, error)
            except Exception as failure:  # a bug in the report must not keep the slot from being released
                message = f"{self.name}: the end of a run could not be reported"
                self._loop.call_exception_handler({"message": message, "exception": failure})
        if group is not None:
            group.give_back(self._loop)
        if self._idle is not None:
            self._look_idle()
        if self.items and not self._waking:
            self.wake()

    def cancel(self) -> asyncio.Future[None]:
        """Stop starting runs, and cancel those in progress, except those already cleaning up after a cancellation.

        Returns:
            A future that is done when all runs have ended.
        """
        if not self._closed and self.group is not None:
            self.group.withdraw(self)
            self.group.members.remove(self)
        self._closed = True
        if self._idle is None:
            self._idle = self._loop.create_future()
        # A second cancellation would interrupt the cleanup.
        for run in list(self.active):
            if not run.cancelling():
                run.cancel()
        self._look_idle()
        return self._idle

    def reopen(self) -> None:
        """Start runs again after `cancel`."""
        if not self._closed:
            return
        self._closed, self._idle = False, None
        if self.group is not None:
            self.group.members.append(self)
        self.wake()

    def _look_idle(self) -> None:
        if self._idle is not None and not self.active and not self._idle.done():
            self._idle.set_result(None)
