"""Two loops that read one subscription, so that each receives only a part of its messages.

Several tasks of one loop may share the messages as a pool of workers; a warning requires loops on different lines.
There is no cost per message: once a second loop has begun, the tasks are inspected once a second.
"""

from __future__ import annotations

import asyncio
import weakref
from collections.abc import Set as AbstractSet

from graphflow.analysis.user_code import short_place
from graphflow.deadlock.asyncio_frames import waiter_of
from graphflow.errors import Place
from graphflow.executor.clock import Alarm
from graphflow.runtime.call_site import here
from graphflow.runtime.part import Host
from graphflow.times import NANOSECONDS

CHECKS = 30
"""Inspections after a loop has begun, at most: two that take turns do not wait at the same time."""


class SharedReading:
    """The loops over one subscription.

    Args:
        waiters: The futures that its readers wait for.
    """

    def __init__(self, host: Host, name: str, waiters: AbstractSet[asyncio.Future[None]]) -> None:
        self._host, self._name, self._waiters = host, name, waiters
        self._readers: weakref.WeakKeyDictionary[object, Place] = weakref.WeakKeyDictionary()
        """The loop that each task has begun last."""
        self._alarm: Alarm | None = None
        self._left = 0
        self._has_warned = False

    def begins(self) -> None:
        """Note a loop that begins in the current task."""
        task = asyncio.current_task()
        if task is None or self._has_warned:
            return
        self._readers[task] = place = here(3)
        if any(other != place for other in self._readers.values()):
            self._left = CHECKS
            if self._alarm is None:
                self._arm()

    def _arm(self) -> None:
        clock = self._host.context.clock
        self._alarm = clock.call_at(clock.monotonic_ns() + NANOSECONDS, self._check)

    def _check(self) -> None:
        self._alarm = None
        self._left -= 1
        waiting = {place for task, place in self._readers.items() if waiter_of(task) in self._waiters}
        if len(waiting) > 1:
            self._has_warned = True
            first, second, *_ = sorted(str(short_place(place.file, place.line)) for place in waiting)
            text = (
                "%s is read in %s and in %s, and each message goes to only one of them: declare a Subscription for each"
            )
            self._host.log.warning(text, self._name, first, second)
        elif self._left > 0:
            self._arm()

    def stop(self) -> None:
        """Stop the inspections."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
