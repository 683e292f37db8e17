"""Whether the nodes answer: each worker's event loop says so once a second, and one that does not is told.

A process is *unresponsive* when its loop has said nothing for `SILENCE` seconds: it is blocked, held in C code, or has
been stopped. That is reported, with the line in which it is blocked; nobody is killed for it. A supervisor that was
held up itself has heard nothing either, and waits for another round.

Source: docs/architecture.md, "The rules of processes"; systemd's WatchdogSec.
"""

from __future__ import annotations

import asyncio
import signal
import time
from collections.abc import Callable, Iterable

from graphflow.machines.process import State
from graphflow.supervisor.processes import process_tree
from graphflow.supervisor.processes.process import Process

LOOK_EVERY = 0.5
"""Seconds between two looks."""
SILENCE = 3.0
"""Seconds without a word after which a process is unresponsive."""


class Health:
    """The looks at a graph's processes.

    Args:
        tell: Called with what is found.
    """

    def __init__(self, processes: Iterable[Process], tell: Callable[[str], None]) -> None:
        self._processes, self._tell = list(processes), tell
        self._looked = time.monotonic()

    async def watch(self) -> None:
        """Look for as long as the graph runs."""
        while True:
            await asyncio.sleep(LOOK_EVERY)
            self.look(time.monotonic())

    def look(self, now: float) -> None:
        """Find who does not answer, and who does again.

        Args:
            now: Seconds on the monotonic clock.
        """
        was_held_up = now - self._looked > 2 * LOOK_EVERY
        self._looked = now
        for process in self._processes:
            if process.state is not State.READY or process.heard is None or process.is_debugged:
                process.silent_since = None
            elif now - process.heard <= SILENCE:
                if process.silent_since is not None:
                    self._tell(f"{process.name} answers again, after {now - process.silent_since:.0f} s")
                process.silent_since = None
            elif process.silent_since is None and not was_held_up:
                process.silent_since = process.heard
                self._tell(f"{process.name} has not answered for {now - process.heard:.0f} s: {_why(process)}")


def _why(process: Process) -> str:
    """What is the matter with a process, as far as can be seen from outside."""
    pid = process.pid or 0
    if process_tree.state_of(pid) == "T":
        return f"process {pid} is stopped; to let it go on: kill -CONT {pid}"
    if hasattr(signal, "SIGUSR2"):
        process_tree.kill(pid, signal.SIGUSR2)  # its faulthandler writes into the log what each of its threads does
        return f"its event loop is blocked; where, its log shows: {process.log}"
    return f"its event loop is blocked; its log: {process.log}"
