"""Errors of asyncio tasks that a program keeps and nothing awaits: `self.driving = asyncio.create_task(...)`.

Python logs such an error when the task is freed, which may be never.
"""

from __future__ import annotations

import logging
from asyncio import AbstractEventLoop, CancelledError, Task
from collections.abc import Iterable, Iterator
from contextlib import suppress
from types import CoroutineType
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakSet

from graphflow.analysis.user_code import is_installed, is_users
from graphflow.deadlock.asyncio_frames import tasks_alive, unread_error
from graphflow.errors import ClosedError
from graphflow.runtime.failures import report

if TYPE_CHECKING:
    from graphflow.runtime.context import Context

logger = logging.getLogger("graphflow")


class Failed(NamedTuple):
    """A task of a user's coroutine that has failed, and that nothing has awaited."""

    task: Task[object]
    name: str
    error: BaseException


def report_kept_errors(context: Context) -> None:
    """Report such errors on a context's loop within a second."""
    context.search.watchdog.on_look = KeptErrors(context.loop).look


def failed_tasks(tasks: Iterable[Task[object]]) -> Iterator[Failed]:
    """Yield those of the tasks that have failed and that nothing has awaited."""
    for task in tasks:
        coroutine, error = task.get_coro(), unread_error(task)
        if error is not None and isinstance(coroutine, CoroutineType):
            file = coroutine.cr_code.co_filename
            if is_users(file) and not is_installed(file):
                yield Failed(task, coroutine.__qualname__, error)


class KeptErrors:
    """The tasks of an event loop, as far as they exist at one of the looks; those that have failed are reported."""

    def __init__(self, loop: AbstractEventLoop) -> None:
        self._loop = loop
        self._known: WeakSet[Task[object]] = WeakSet()
        self._failed: WeakSet[Task[object]] = WeakSet()
        """Tasks that had failed at the last look: somebody may be about to await them."""

    def failed(self) -> list[Failed]:
        """Return the tasks that have failed and that nothing has awaited."""
        with suppress(RuntimeError):  # a task was made meanwhile: it is found at the next look
            self._known.update(tasks_alive(self._loop))
        return [*failed_tasks([*self._known])]

    def look(self) -> None:
        """Report the tasks that had failed at the look before, too. May run on any thread."""
        failed = self.failed()
        for task, name, error in failed:
            if task not in self._failed:
                continue
            with suppress(CancelledError):
                task.exception()  # or it is logged again when the task is freed
            if not isinstance(error, ClosedError):  # its node has stopped in the meantime
                way = "await it, or start it with self.spawn(...), which ends the node on an error"
                report(logger, f"{name} failed, and nothing awaits it ({way})", error)
        self._failed = WeakSet(task for task, _, _ in failed)
