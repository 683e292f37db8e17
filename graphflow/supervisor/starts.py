"""Graphs that are being started: known from the first moment on, though not yet by name or domain.

    $XDG_RUNTIME_DIR/graphflow/<process id>.start   the graph file, once it is known; locked until there is a run file

The command announces its graph, and that before it imports anything else: so it is seen by every `down` that begins
after it, which imports as much.

Source: flock(2); a lock goes with its process, however that ends.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from graphflow.errors import SupervisorError
from graphflow.supervisor.rundir import is_locked, lock_file, runtime_root

PATIENCE = 30.0
"""Seconds that a start may take until its graph can be asked: importing all classes may take most of them."""


class Start(NamedTuple):
    """A graph that is being started."""

    pid: int
    """The command."""
    file: str
    """Empty as long as the command has not found it."""

    def __str__(self) -> str:
        return f"{self.file or 'a graph'}, which is being started by process {self.pid}"


class Announcement:
    """Tells others that this process starts a graph, from `begin` until it is told that this is done."""

    def __init__(self) -> None:
        self._path = Path()
        self._fd = -1

    def begin(self, file: Path | None = None) -> None:
        """Announce a graph, or, when it has been announced without its file, this.

        Raises:
            SupervisorError: The file for it cannot be written.
        """
        self._path = runtime_root() / f"{os.getpid()}.start"
        fresh, before = self._path.with_suffix(".start.new"), self._fd
        try:
            self._fd = os.open(fresh, os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
            lock_file(self._fd)
            os.write(self._fd, b"" if file is None else os.fsencode(file.resolve()))
            fresh.replace(self._path)  # from here on others see it; one that nobody has locked they would remove
        except OSError as error:
            raise SupervisorError(f"{self._path}: {error.strerror}") from None
        finally:
            if before >= 0:
                os.close(before)

    def leave(self) -> None:
        """Leave it to the parent, in a forked child: else it would stay locked as long as this lives."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def end(self) -> None:
        """The graph has a run file, or will have none."""
        if self._fd >= 0:
            self._path.unlink(missing_ok=True)
            self.leave()


ANNOUNCEMENT = Announcement()
"""That of this process."""


def starting() -> list[Start]:
    """The graphs of this user that are being started now."""
    found = []
    for path in sorted(runtime_root().glob("*.start")):
        if is_locked(path):
            try:
                found.append(Start(int(path.stem), os.fsdecode(path.read_bytes())))
            except (OSError, ValueError):  # it is done by now
                continue
        else:  # its process was killed
            path.unlink(missing_ok=True)
    return found


def being_started() -> str:
    """The graphs of this user that are being started, for a command that has found none; empty if there are none."""
    files = ", ".join(f"{start.file or 'a graph'} (process {start.pid})" for start in starting())
    return f"being started: {files}; wait for it with: graphflow wait" if files else ""


def wait_started(told: Callable[[Start], object], file: Path | None = None) -> bool:
    """Wait until the graphs that are being started now can be asked, or have failed; returns whether there were any.

    Args:
        told: Called with each that is waited for.
        file: Only those of this graph file, as far as they are known.

    Raises:
        SupervisorError: One has not begun within `PATIENCE` (exit 4).
    """
    begun = [start for start in starting() if file is None or start.file == str(file.resolve())]
    for start in begun:
        told(start)
    deadline, pids = time.monotonic() + PATIENCE, {start.pid for start in begun}
    while left := [start for start in starting() if start.pid in pids]:
        if time.monotonic() > deadline:
            slow = min(left)
            text = f"{slow}, is not up after {PATIENCE:g} s; to break that off: kill {slow.pid}"
            raise SupervisorError(text, exit_code=4)
        time.sleep(0.01)
    return bool(begun)
