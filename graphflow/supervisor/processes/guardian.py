"""The guardian: the supervisor's parent, which ends the rest of a graph when the supervisor has ended.

It does nothing else, so that no failure elsewhere can end it. If the supervisor was killed, the preload process asks
the nodes to end, as the supervisor would have, and the guardian kills those that still run after `GRACE`.
"""

from __future__ import annotations

import json
import os
import signal
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from graphflow.errors import SupervisorError
from graphflow.supervisor.processes import process_tree

if TYPE_CHECKING:
    from graphflow.supervisor.rundir import RunDirectory

GRACE = 1.0
"""Seconds that nodes have to clean up after their supervisor was killed."""


class Charge(NamedTuple):
    """The graph that a guardian is in charge of."""

    domain: int
    graph: str
    log: str
    """The supervisor's log."""


def guard(supervise: Callable[[], int], note: int, descriptors: tuple[int, ...]) -> NoReturn:
    """Fork the supervisor and guard it; exits with the supervisor's exit code.

    Args:
        supervise: Runs the supervisor; returns its exit code.
        note: The reading end of the pipe for `leave_note`.
        descriptors: Descriptors that only the supervisor needs.
    """
    process_tree.adopt_orphans()
    process_tree.name_process("gf-guardian", "guardian")
    pid = os.fork()
    if pid == 0:
        code = 1
        try:
            code = supervise()
        finally:
            os._exit(code)
    # The command's terminal, or the pipe it writes to, must not be kept open by a graph that outlives the command.
    null = os.open(os.devnull, os.O_RDWR)
    for fd in (0, 1, 2):
        os.dup2(null, fd)
    for fd in (null, *descriptors):
        os.close(fd)
    # After the fork, since children inherit ignored signals, and the supervisor acts on SIGTERM.
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    code = os.waitstatus_to_exitcode(_wait_for(pid))
    try:
        if code < 0:
            data = os.read(note, 65536)
            charge = Charge(**json.loads(data)) if data else None
            clean_up(charge, pid, _describe(code), partial(process_tree.descendants, os.getpid()))
    finally:  # an error with files must not leave processes behind
        process_tree.end_descendants(os.getpid(), process_tree.reap_children)
        os._exit(code if code >= 0 else 128 - code)


def leave_note(pipe: int, domain: int, graph: str, log: Path) -> None:
    """Write down, for the guardian, what to clean up if this process is killed."""
    os.write(pipe, json.dumps(Charge(domain, graph, str(log))._asdict()).encode())


def _wait_for(pid: int) -> int:
    """Wait for the supervisor, and reap orphans meanwhile; returns its status."""
    while True:
        ended, status = os.waitpid(-1, 0)
        if ended == pid:
            return status


def clean_up(charge: Charge | None, pid: int, how: str, find: Callable[[], list[int]]) -> None:
    """Do the rest of a killed supervisor's work: end all processes, release the run directory, log the end.

    Args:
        charge: The graph; None if the supervisor was killed before it had left a note.
        pid: The supervisor.
        how: The cause of its end.
        find: Finds the processes of the graph that still live.
    """
    # Claimed first: no other supervisor may start this graph while its processes live.
    directory = _claimed(charge.domain, charge.graph) if charge is not None else None
    deadline = time.monotonic() + GRACE
    while find() and time.monotonic() < deadline:
        process_tree.reap_children()
        time.sleep(0.01)
    left = len(find())
    process_tree.end_all(find, process_tree.reap_children)
    if directory is not None:
        directory.release()
    if charge is not None:
        _log_end(charge.log, pid, how, left)


def _describe(code: int) -> str:
    from graphflow.machines.process import Exit

    return str(Exit.of_status(code))


def _claimed(domain: int, graph: str) -> RunDirectory | None:
    """Claim the run directory; None if that fails, as when the graph has been started again."""
    from graphflow.supervisor.rundir import RunDirectory

    try:
        directory = RunDirectory(domain, graph)
        directory.claim()
    except SupervisorError:
        return None
    return directory


def _log_end(log: str, pid: int, how: str, left: int) -> None:
    were = "1 process that was left was" if left == 1 else f"{left} processes that were left were"
    killed = f"; {were} killed" if left else ""
    text = f"the supervisor, process {pid}, was ended by {how}; its nodes have ended{killed}\n"
    with open(log, "a", encoding="utf-8") as file:
        file.write(text)
