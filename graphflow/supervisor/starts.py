"""Graphs that are being started: announced from the first moment on, before their name and domain are known.

    $XDG_RUNTIME_DIR/graphflow/<process id>.start   the graph file, once it is known; locked until there is a run file

The command announces its graph before it imports anything else, so that every `down` that is typed after it sees it.

Source: flock(2): a lock ends with its process, however that ends.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from graphflow.errors import SupervisorError
from graphflow.reading import found_bytes
from graphflow.supervisor.rundir import is_locked, lock_file, runtime_root

PATIENCE = 30.0
"""Seconds until the graph must have a control socket: importing all classes may take most of them."""


class Start(NamedTuple):
    """A graph that is being started."""

    pid: int
    """The command."""
    file: str
    """The graph file; empty until the command has found it."""

    def __str__(self) -> str:
        return f"{self.file or 'a graph'}, which is being started by process {self.pid}"


class Announcement:
    """The announcement, to other processes, that this one starts a graph: from `begin` to `end`."""

    def __init__(self) -> None:
        self._path = Path()
        self._fd = -1

    def begin(self, file: Path | None = None) -> None:
        """Announce a graph, at first perhaps without its file.

        Raises:
            SupervisorError: The announcement cannot be written.
        """
        self._path = runtime_root() / f"{os.getpid()}.start"
        fresh, before = self._path.with_suffix(".start.new"), self._fd
        try:
            self._fd = os.open(fresh, os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
            lock_file(self._fd)
            os.write(self._fd, b"" if file is None else os.fsencode(file.resolve()))
            fresh.replace(self._path)  # locked before it is visible: others remove unlocked ones
        except OSError as error:
            raise SupervisorError(f"{self._path}: {error.strerror}") from None
        finally:
            # Only now, so that the announcement is locked at every moment.
            if before >= 0:
                os.close(before)

    def leave(self) -> None:
        """Leave the announcement to the parent, in a forked child, which would keep it locked."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def end(self) -> None:
        """Withdraw the announcement: the graph has a run file, or will have none."""
        if self._fd >= 0:
            self._path.unlink(missing_ok=True)
            self.leave()


ANNOUNCEMENT = Announcement()
"""The announcement of this process."""


def starting() -> list[Start]:
    """Return the graphs of this user that are being started."""
    found = []
    for path in sorted(runtime_root().glob("*.start")):
        if is_locked(path):
            try:
                found.append(Start(int(path.stem), os.fsdecode(found_bytes(path))))
            except (OSError, ValueError):  # it has just ended
                continue
        else:  # its process was killed
            path.unlink(missing_ok=True)
    return found


def being_started() -> str:
    """Describe the graphs of this user that are being started; empty if there are none."""
    files = ", ".join(f"{start.file or 'a graph'} (process {start.pid})" for start in starting())
    return f"being started: {files}; wait for it with: graphflow wait" if files else ""


def wait_started(on_wait: Callable[[Start], object], file: Path | None = None) -> bool:
    """Wait until the graphs that are being started have a control socket or have failed.

    Args:
        on_wait: Called with each graph before the wait.
        file: Wait only for graphs of this file.

    Returns:
        Whether there were any.

    Raises:
        SupervisorError: One has no control socket within `PATIENCE` (exit 4).
    """
    pending = [start for start in starting() if file is None or start.file == str(file.resolve())]
    for start in pending:
        on_wait(start)
    deadline, pids = time.monotonic() + PATIENCE, {start.pid for start in pending}
    while left := [start for start in starting() if start.pid in pids]:
        if time.monotonic() > deadline:
            slow = min(left)
            text = f"{slow}, is not up after {PATIENCE:g} s; to cancel it: kill {slow.pid}"
            raise SupervisorError(text, exit_code=4)
        time.sleep(0.01)
    return bool(pending)
