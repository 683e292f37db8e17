"""The guardian's successor: it replaces a guardian that was killed.

No process can become the parent of one that runs. So the successor is a child of the supervisor, whose end it sees on a
pipe, and it finds the processes of the graph by their log files, which are the graph's own. A supervisor that ends by
itself ends it, too. A successor that is killed is replaced in its turn, up to a limit.

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
from graphflow.supervisor.processes.guardian import Charge, clean_up
from graphflow.supervisor.processes.orphaned import LOG_VARIABLE
from graphflow.supervisor.rundir import SUPERVISOR_LOG, GraphRun, start_time

INTENSITY = Backoff("always", max_restarts=3, within=60.0)
"""The limit of restarts."""
_COMMAND = (sys.executable, "-P", "-m", "graphflow.supervisor.processes.successor")


class GuardianWatch:
    """The watch over a graph's guardian, by its supervisor.

    Args:
        run: The graph; its guardian is 0 if it has none to be replaced.
    """

    def __init__(self, run: GraphRun) -> None:
        self.run = run
        """The graph with its present guardian."""
        self._restarts = Restarts(INTENSITY)
        self._goes_on = bool(run.guardian)
        self._successor: subprocess.Popen[bytes] | None = None

    def check(self) -> str:
        """Start another guardian if there is none any more; returns a remark on that, or an empty string."""
        if not self._goes_on or self._is_guarded():
            return ""
        ended = self.run.unguarded or f"the guardian, process {self.run.guardian}, was ended"
        follows = self._restarts.decide(Exit(), 0.0, time.monotonic(), 0.0)
        why = follows.why if isinstance(follows, GiveUp) else self._start()
        self._goes_on = not why
        if why:
            return f"{ended}; the graph goes on without it: {why}"
        return f"{ended}; process {self.run.guardian} has taken its place"

    def _is_guarded(self) -> bool:
        if self._successor is not None:
            return self._successor.poll() is None
        return os.getppid() == self.run.guardian

    def _start(self) -> str:
        """Start a successor; returns the reason if that fails, or an empty string."""
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
    """Return the living processes of the graph that logs to a folder, and their descendants, without this process."""
    mark, folder = f"{LOG_VARIABLE}={logs}/".encode(), f"{logs}/"
    found: set[int] = set()
    for pid in process_tree.processes():
        is_marked = any(variable.startswith(mark) for variable in process_tree.environment(pid))
        if is_marked or any(file.startswith(folder) for file in process_tree.output(pid)):
            found |= {pid, *process_tree.descendants(pid)}
    return sorted(found - {os.getpid()})


def main() -> None:
    """Wait for the supervisor's end, then end the rest of the graph, which is described on the standard input."""
    process_tree.name_process("gf-guardian", "guardian")
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    with os.fdopen(0, "rb", closefd=False) as supervisor:
        note = json.loads(supervisor.readline())
        supervisor.read()  # until the supervisor's end closes the pipe
    log = str(Path(note["logs"]) / SUPERVISOR_LOG)
    how = "an unknown cause: the guardian, which would know, was killed before"
    clean_up(Charge(note["domain"], note["graph"], log), note["pid"], how, partial(left_of, note["logs"]))


if __name__ == "__main__":
    main()
