"""Errors of asyncio tasks that a program keeps and nothing awaits: `self.driving = asyncio.create_task(...)`.

Python logs such an error when the task is freed, which may be never.
"""

from __future__ import annotations

import asyncio
import logging
from asyncio import AbstractEventLoop, CancelledError, Task
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

from graphflow.analysis.user_code import is_installed, is_users
from graphflow.errors import ClosedError
from graphflow.runtime.failures import report

if TYPE_CHECKING:
    from graphflow.runtime.context import Context

logger = logging.getLogger("graphflow")


def report_kept_errors(context: Context) -> None:
    """Report such errors on a context's loop within a second."""
    context.search.watchdog.on_look.append(KeptErrors(context.loop).look)


def failed_tasks(tasks: Iterable[Task[Any]]) -> Iterator[tuple[Task[Any], BaseException]]:
    """Yield the tasks of user-defined coroutines that have failed and that nothing has awaited, with their errors."""
    for task in tasks:
        # The attribute is that of asyncio's own test: `exception()` would count as having read the error.
        if not task.done() or task.cancelled() or not getattr(task, "_log_traceback", False):
            continue
        code = getattr(task.get_coro(), "cr_code", None)
        error = getattr(task, "_exception", None)
        if code is not None and _is_users_own(code.co_filename) and isinstance(error, BaseException):
            yield task, error


def name_of(task: Task[Any]) -> str:
    """Return the name of a task's coroutine."""
    return str(getattr(task.get_coro(), "__qualname__", "a task"))


def _is_users_own(file: str) -> bool:
    return is_users(file) and not is_installed(file)


class KeptErrors:
    """The tasks of an event loop, as far as they exist at one of the looks; those that have failed are reported."""

    def __init__(self, loop: AbstractEventLoop) -> None:
        self._loop = loop
        self._known: WeakSet[Task[Any]] = WeakSet()
        self._failed: WeakSet[Task[Any]] = WeakSet()
        """Tasks that had failed at the last look: somebody may be about to await them."""

    def tasks(self) -> list[Task[Any]]:
        """Return the tasks of the loop that still exist, done or not; none if another thread is making one."""
        # Up to Python 3.13 asyncio knows every task until it is freed; later, only those that run.
        known: Any = getattr(asyncio.tasks, "_scheduled_tasks", None) or getattr(asyncio.tasks, "_all_tasks", ())
        with suppress(RuntimeError):  # the set changed while it was read, which asyncio.all_tasks tries again
            self._known.update(task for task in [*known] if task.get_loop() is self._loop)
            self._known.update(asyncio.all_tasks(self._loop))
            return [*self._known]
        return []

    def look(self) -> None:
        """Report the tasks that have failed since the look before the last one. May run on any thread."""
        failed = dict(failed_tasks(self.tasks()))
        for task in [task for task in failed if task in self._failed]:
            error = failed.pop(task)
            with suppress(CancelledError):
                task.exception()  # or it is logged again when the task is freed
            if not isinstance(error, ClosedError):  # its node has stopped in the meantime
                way = "await it, or start it with self.spawn(...), which ends the node on an error"
                report(logger, f"{name_of(task)} failed, and nothing awaits it ({way})", error)
        self._failed = WeakSet(failed)
