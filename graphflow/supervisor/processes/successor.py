"""The guardian's successor: another process that ends what is left of a graph, where the guardian was killed.

Nobody can become the parent of a process that runs. So the successor is a child of the supervisor's, to whose end it
listens on a pipe, and finds what is left by its logs, which no other graph has. A supervisor that ends by itself ends
it, too. One that is killed in its turn is followed by another, but not without limit.

Source: pipe(7) for a pipe whose other end is closed.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

from graphflow.machines.process import Exit
from graphflow.machines.restarts import Backoff, GiveUp, Restarts
from graphflow.supervisor.processes import process_tree
from graphflow.supervisor.processes.guardian import clean_up
from graphflow.supervisor.processes.orphaned import LOG_VARIABLE
from graphflow.supervisor.rundir import SUPERVISOR_LOG, GraphRun, start_time

INTENSITY = Backoff("always", max_restarts=3, within=60.0)
"""How often a guardian is started again."""
_COMMAND = (sys.executable, "-P", "-m", "graphflow.supervisor.processes.successor")


class Guard:
    """Sees to it that a graph has a guardian, for its supervisor.

    Args:
        run: The graph; its guardian is 0 where there is none to be replaced.
    """

    def __init__(self, run: GraphRun) -> None:
        self.run = run
        """With the guardian that there is now."""
        self._restarts = Restarts(INTENSITY)
        self._goes_on = bool(run.guardian)
        self._successor: subprocess.Popen[bytes] | None = None

    def look(self) -> str:
        """Start another guardian if there is none any more; returns what has happened, in words, or nothing."""
        if not self._goes_on or self._is_there():
            return ""
        ended = self.run.unguarded or f"the guardian, process {self.run.guardian}, was ended"
        follows = self._restarts.decide(Exit(), 0.0, time.monotonic(), 0.0)
        why = follows.why if isinstance(follows, GiveUp) else self._start()
        self._goes_on = not why
        if why:
            return f"{ended}; the graph goes on without it: {why}"
        return f"{ended}; process {self.run.guardian} has taken its place"

    def _is_there(self) -> bool:
        if self._successor is not None:
            return self._successor.poll() is None
        return os.getppid() == self.run.guardian

    def _start(self) -> str:
        """Start another; returns why it cannot be, if so."""
        run, null = self.run, subprocess.DEVNULL
        note = json.dumps({"domain": run.domain, "graph": run.graph, "pid": run.pid, "logs": run.logs})
        try:
            process = subprocess.Popen(
                _COMMAND, stdin=subprocess.PIPE, stdout=null, stderr=null, bufsize=0, start_new_session=True
            )
        except OSError as error:  # no memory, no free process
            return f"another cannot be started: {error.strerror}"
        assert process.stdin is not None
        with suppress(BrokenPipeError):  # it was killed, too
            process.stdin.write(note.encode() + b"\n")
        if self._successor is not None and self._successor.stdin is not None:
            self._successor.stdin.close()
        self._successor = process
        self.run = replace(run, guardian=process.pid, guardian_started=start_time(process.pid) or 0.0)
        return ""


def left_of(logs: str) -> list[int]:
    """The living processes of the graph with a folder of logs, and what they have started, without this one."""
    mark, folder = f"{LOG_VARIABLE}={logs}/".encode(), f"{logs}/"
    found: set[int] = set()
    for pid in process_tree.processes():
        is_marked = any(variable.startswith(mark) for variable in process_tree.environment(pid))
        if is_marked or any(file.startswith(folder) for file in process_tree.output(pid)):
            found |= {pid, *process_tree.descendants(pid)}
    return sorted(found - {os.getpid()})


def main() -> None:
    """Wait for the supervisor's end, and end what is left; on the standard input is which graph it is."""
    process_tree.name_process("gf-guardian", "guardian")
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    with os.fdopen(0, "rb", closefd=False) as supervisor:
        note = json.loads(supervisor.readline())
        supervisor.read()
    known = {"domain": note["domain"], "graph": note["graph"], "log": str(Path(note["logs"]) / SUPERVISOR_LOG)}
    how = "an unknown cause, which only the guardian that was killed before would know"
    clean_up(known, note["pid"], how, partial(left_of, note["logs"]))


if __name__ == "__main__":
    main()
