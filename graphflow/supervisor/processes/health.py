"""The health check: the event loop of each worker reports a beat once a second, and its silence is reported.

A process is *unresponsive* when `SILENCE` seconds have passed since its last beat: its loop is blocked, perhaps in C
code, or the process is stopped. That is reported, with the place where its stack is logged; the process is not killed.
A supervisor that was held up itself could not read beats meanwhile, and waits for another round.

Source: docs/architecture.md, "The rules of processes"; systemd's WatchdogSec.
"""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import Callable, Iterable

from graphflow.deadlock.watchdog import BLOCKED
from graphflow.machines.process import State
from graphflow.supervisor.processes import process_tree
from graphflow.supervisor.processes.process import Process

CHECK_EVERY = 0.5
"""Seconds between two checks."""
SILENCE = 3.0
"""Seconds without a beat after which a process is unresponsive."""
_TAIL = 8192
"""Bytes at the end of a log that are searched."""


class Health:
    """The health check of a graph's processes.

    Args:
        note: Called with each finding, in words.
    """

    def __init__(self, processes: Iterable[Process], note: Callable[[str], None]) -> None:
        self._processes, self._note = list(processes), note
        self._checked = time.monotonic()

    async def watch(self) -> None:
        """Check until cancelled."""
        while True:
            await asyncio.sleep(CHECK_EVERY)
            self.check(time.monotonic())

    def check(self, now: float) -> None:
        """Report processes that have become unresponsive, and those that answer again.

        Args:
            now: Seconds on the monotonic clock.
        """
        was_held_up = now - self._checked > 2 * CHECK_EVERY
        self._checked = now
        for process in self._processes:
            if process.state is not State.READY or process.last_beat is None or process.is_debugged:
                process.silent_since = None
            elif now - process.last_beat <= SILENCE:
                if process.silent_since is not None:
                    self._note(f"{process.name} answers again, after {now - process.silent_since:.0f} s")
                process.silent_since = None
            elif process.silent_since is None and not was_held_up:
                process.silent_since = process.last_beat
                self._note(f"{process.name} has not answered for {now - process.last_beat:.0f} s: {_why(process)}")


def _why(process: Process) -> str:
    """Explain why a process does not answer, as far as can be seen from outside."""
    pid = process.pid or 0
    if process_tree.state_of(pid) == "T":
        return f"process {pid} is stopped; to let it go on: kill -CONT {pid}"
    if hasattr(signal, "SIGUSR2") and not _is_logged(process.log):
        process_tree.kill(pid, signal.SIGUSR2)  # its faulthandler dumps the stacks of all threads into the log
    return f"its event loop is blocked; its log shows where: {process.log}"


def _is_logged(log: str) -> bool:
    """Whether a process has logged that its loop is blocked, and where; while C code holds the GIL, it cannot."""
    try:
        with open(log, "rb") as file:
            file.seek(max(0, os.fstat(file.fileno()).st_size - _TAIL))
            return BLOCKED.encode() in file.read(_TAIL)
    except OSError:  # such as a log whose folder was deleted
        return False
