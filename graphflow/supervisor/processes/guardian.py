"""The guardian: the supervisor's parent, which ends whatever is left of a graph when the supervisor has ended.

It does nothing else, so nothing else can end it. After a supervisor that was killed the preload process asks the nodes
to end, as the supervisor would have, and what is still there after `GRACE` is killed here.
"""

from __future__ import annotations

import json
import os
import signal
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from graphflow.errors import SupervisorError
from graphflow.supervisor.processes import process_tree

if TYPE_CHECKING:
    from graphflow.supervisor.rundir import RunDirectory

GRACE = 1.0
"""Seconds that nodes have for their cleanup when their supervisor was killed."""


def guard(supervise: Callable[[], int], note: int, descriptors: tuple[int, ...]) -> NoReturn:
    """Fork the supervisor, and be its guardian; ends with the supervisor's exit code.

    Args:
        supervise: What the supervisor does; returns its exit code.
        note: The reading end of a pipe into which the supervisor puts, once it knows, `leave_note`.
        descriptors: What only the supervisor needs.
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
    # The command's terminal, or the pipe it writes to, must not be kept open by a graph that goes on.
    null = os.open(os.devnull, os.O_RDWR)
    for fd in (0, 1, 2):
        os.dup2(null, fd)
    for fd in (null, *descriptors):
        os.close(fd)
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    code = os.waitstatus_to_exitcode(_wait_for(pid))
    try:
        if code < 0:
            known = os.read(note, 65536)
            below = partial(process_tree.descendants, os.getpid())
            clean_up(json.loads(known) if known else {}, pid, _words(code), below)
    finally:  # whatever goes wrong with files, nothing is left
        process_tree.end_descendants(os.getpid(), process_tree.reap_children)
        os._exit(code if code >= 0 else 128 - code)


def leave_note(pipe: int, domain: int, graph: str, log: Path) -> None:
    """Say what is to be cleaned up if this process is killed."""
    os.write(pipe, json.dumps({"domain": domain, "graph": graph, "log": str(log)}).encode())


def _wait_for(pid: int) -> int:
    """Wait for the supervisor, and for orphans meanwhile; returns its status."""
    while True:
        ended, status = os.waitpid(-1, 0)
        if ended == pid:
            return status


def clean_up(known: dict[str, Any], pid: int, how: str, find: Callable[[], list[int]]) -> None:
    """Do what the supervisor did not live to do: hold the run directory until all has ended, and say how it ended.

    Args:
        known: What `leave_note` has said; nothing if the supervisor had not come that far.
        pid: The supervisor.
        how: What ended it.
        find: Finds what is left of the graph.
    """
    directory = _claimed(known["domain"], known["graph"]) if known else None
    deadline = time.monotonic() + GRACE
    while find() and time.monotonic() < deadline:
        process_tree.reap_children()
        time.sleep(0.01)
    left = len(find())
    process_tree.end_all(find, process_tree.reap_children)
    if directory is not None:
        directory.release()
    if known:
        _tell(known["log"], pid, how, left)


def _words(code: int) -> str:
    from graphflow.machines.process import Exit

    return str(Exit.of_status(code))


def _claimed(domain: int, graph: str) -> RunDirectory | None:
    """The run directory; None if it cannot be had, or the graph has been started again."""
    from graphflow.supervisor.rundir import RunDirectory

    try:
        directory = RunDirectory(domain, graph)
        directory.claim()
    except SupervisorError:
        return None
    return directory


def _tell(log: str, pid: int, how: str, left: int) -> None:
    were = "1 process that was left was" if left == 1 else f"{left} processes that were left were"
    killed = f"; {were} killed" if left else ""
    text = f"the supervisor, process {pid}, was ended by {how}; its nodes have ended{killed}\n"
    with open(log, "a", encoding="utf-8") as file:
        file.write(text)
