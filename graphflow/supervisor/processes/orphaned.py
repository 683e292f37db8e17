"""Ending a worker: it ends what it has started, for perhaps nobody is left above it who could.

A worker that ends by itself does so before; what one leaves that was killed, the preload process ends. If that or the
supervisor has ended, the worker is asked to end by the other or by the kernel (`system.end_with_parent`). What is there
after `GRACE` is killed by those of the three above the workers that live; if all were killed together, each worker
kills its own.

Source: pipe(7) and poll(2) for a pipe whose other end is closed: of the orders' pipe the preload process alone has it,
of the status pipe the supervisor.
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
"""The variable that programs of a worker inherit: the file of its output, which no other process has."""


class Orphan:
    """Ends a worker and what it has started when its preload process has ended.

    Args:
        parent: The preload process.
        status: The writing end of the status pipe.
        orders: The reading end of the orders' pipe.
        log: The worker's log.
    """

    def __init__(self, parent: int, status: int, orders: int, log: str) -> None:
        self._parent, self._status, self._orders, self._log = parent, status, orders, log

    def end_on_sigterm(self) -> None:
        """Do it on SIGTERM, while nothing else handles that: when the worker makes its nodes."""
        signal.signal(signal.SIGTERM, self._end_by)

    def _end_by(self, number: int, frame: FrameType | None) -> None:
        self._end_own_if_orphaned()
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    def watch(self) -> None:
        """Do it on a thread, for event loops that are blocked and handlers of signals that were replaced."""
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
        """End what this process has started; a look at all processes, unless it has started none."""
        if process_tree.has_started_any():
            process_tree.end_all(partial(left_by, self._log), process_tree.reap_children)


def _poll(pipe: int, timeout: int | None) -> bool:
    """Wait until the other end of a pipe is closed; returns whether it is."""
    end = select.poll()
    end.register(pipe, 0)
    return bool(end.poll(timeout))


def left_by(log: str) -> list[int]:
    """The living processes that the worker with a log has started, daemons included, without itself."""
    mark = f"{LOG_VARIABLE}={log}".encode()
    found = set(process_tree.descendants(os.getpid()))
    for pid in process_tree.processes():
        if mark in process_tree.environment(pid) or log in process_tree.output(pid):
            found.add(pid)
    return sorted(found - {os.getpid()})
