"""Orphaned workers: a worker ends the processes it has started itself when no process above it is left to do so.

A worker that ends by itself ends its processes first; the preload process ends those of a worker that was killed. If
the preload process or the supervisor has ended, the other one or the kernel (`system.end_with_parent`) asks the worker
to end. After `GRACE`, the guardian, supervisor or preload process, if any lives, kills the processes that are left; if
all three were killed together, each worker kills its own.

Source: pipe(7) and poll(2) for a pipe whose other end is closed: only the preload process has that of the orders' pipe,
only the supervisor that of the status pipe.
"""

from __future__ import annotations

import os
import select
import signal
import threading
import time
from functools import partial
from types import FrameType

from graphflow.supervisor.processes import process_tree
from graphflow.supervisor.processes.guardian import GRACE

LOG_VARIABLE = "GRAPHFLOW_LOG"
"""Variable with the path of a worker's log, which marks every process that the worker has started."""


class Orphan:
    """The end of a worker, and of its processes, after that of its preload process.

    Args:
        parent: The preload process.
        status: The writing end of the status pipe.
        orders: The reading end of the orders' pipe.
        log: The worker's log.
    """

    def __init__(self, parent: int, status: int, orders: int, log: str) -> None:
        self._parent, self._status, self._orders, self._log = parent, status, orders, log

    def end_on_sigterm(self) -> None:
        """Act on SIGTERM as long as nothing else handles it: while the worker creates its nodes."""
        signal.signal(signal.SIGTERM, self._end_by)

    def _end_by(self, number: int, frame: FrameType | None) -> None:
        self._end_own_if_orphaned()
        # By the signal, so that the exit status names it.
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    def watch(self) -> None:
        """Act on a thread, in case the event loop is blocked or the user's code has replaced signal handlers."""
        threading.Thread(target=self._wait, name="graphflow-orphaned", daemon=True).start()

    def _wait(self) -> None:
        _poll(self._orders, None)
        time.sleep(GRACE)
        self._end_own_if_orphaned()
        os.kill(os.getpid(), signal.SIGKILL)

    def _end_own_if_orphaned(self) -> None:
        if os.getppid() != self._parent or _poll(self._status, 0):
            self.end_own()

    def end_own(self) -> None:
        """End all processes that this one has started."""
        if process_tree.has_started_any():  # the scan of all processes costs milliseconds
            process_tree.end_all(partial(left_by, self._log), process_tree.reap_children)


def _poll(pipe: int, timeout: int | None) -> bool:
    """Wait until the other end of a pipe is closed; returns whether it is."""
    end = select.poll()
    # No events: the closing of the other end is reported in any case (poll(2), POLLHUP and POLLERR).
    end.register(pipe, 0)
    return bool(end.poll(timeout))


def left_by(log: str) -> list[int]:
    """Return the living processes, daemons included, that the worker with a log has started; not the worker."""
    mark = f"{LOG_VARIABLE}={log}".encode()
    found = set(process_tree.descendants(os.getpid()))
    for pid in process_tree.processes():
        if mark in process_tree.environment(pid) or log in process_tree.output(pid):
            found.add(pid)
    return sorted(found - {os.getpid()})
