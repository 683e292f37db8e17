"""A node's output on its way into its log: the file stays of bounded size, and a full disk costs lines, not the node.

<node>.log       what the node has written last
<node>.log.1     what it has written before, up to the same size
"""

from __future__ import annotations

import io
import os
import sys
import threading
from collections.abc import Callable

LIMIT = 50_000_000
"""Bytes from which on a log is put aside and a new one begun."""


class LogFile(io.RawIOBase):
    """Where standard output and error of a worker go: descriptors 1 and 2, which are this file.

    Args:
        told: Called with the reason when lines begin to be lost.
    """

    def __init__(self, path: str, told: Callable[[str], object]) -> None:
        super().__init__()
        self._path, self._told = path, told
        self._lock = threading.Lock()
        self._lost = 0
        self._written = 0
        """Bytes since the file was last looked at."""

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return 1

    def write(self, data: object) -> int:
        """Write; what does not fit on the disk is counted, and told when there is room again."""
        view = memoryview(data).cast("B")  # type: ignore[arg-type]
        with self._lock:
            try:
                if self._lost:
                    os.write(1, f"({self._lost} bytes could not be written here)\n".encode())
                    self._lost = 0
                rest = view
                while rest:
                    rest = rest[os.write(1, rest) :]
            except OSError as error:
                if not self._lost:
                    self._told(error.strerror or str(error))
                self._lost += len(view)
                return len(view)
            self._written += len(view)
            if self._written > LIMIT // 8:
                self._written = 0
                self._rotate()
        return len(view)

    def _rotate(self) -> None:
        """Begin a new file when this one has become too long."""
        try:
            if os.fstat(1).st_size < LIMIT:
                return
            os.replace(self._path, f"{self._path}.1")
            fresh = os.open(self._path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        except OSError as error:  # an open file cannot be put aside on Windows; it goes on growing
            self._told(f"it cannot be put aside: {error.strerror}")
            return
        os.dup2(fresh, 1)
        os.dup2(fresh, 2)
        os.close(fresh)


def write_to(path: str, told: Callable[[str], object]) -> None:
    """Have this process's standard output and error, which are this file already, kept within bounds."""
    raw = LogFile(path, told)
    for name in ("stdout", "stderr"):
        getattr(sys, name).flush()
        buffer = io.BufferedWriter(raw)
        setattr(sys, name, io.TextIOWrapper(buffer, "utf-8", "backslashreplace", line_buffering=True))
