"""Log files of bounded size for the output of workers; a full disk costs lines, not the node.

<node>.log       the latest output
<node>.log.1     the output before, up to the same size
"""

from __future__ import annotations

import io
import os
import sys
import threading
from collections.abc import Callable

LIMIT = 50_000_000
"""Size in bytes at which a log is rotated."""


class LogFile(io.RawIOBase):
    """The file behind standard output and error of a worker, that is, behind descriptors 1 and 2.

    Args:
        on_loss: Called with the reason when lines begin to be lost.
    """

    def __init__(self, path: str, on_loss: Callable[[str], object]) -> None:
        super().__init__()
        self._path, self._on_loss = path, on_loss
        self._lock = threading.Lock()
        self._lost = 0
        """Bytes that could not be written."""
        self._written = 0
        """Bytes since the size was last checked."""

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return 1

    def write(self, data: object) -> int:
        """Write; bytes that do not fit on the disk are counted, and the count is logged when there is room again."""
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
                    self._on_loss(error.strerror or str(error))
                self._lost += len(view)
                return len(view)
            self._written += len(view)
            if self._written > LIMIT // 8:
                self._written = 0
                self._rotate()
        return len(view)

    def _rotate(self) -> None:
        """Start a new file if this one is too long."""
        try:
            # The size of the file, not a count of these writes: C code and child processes write to it, too.
            if os.fstat(1).st_size < LIMIT:
                return
            os.replace(self._path, f"{self._path}.1")
            fresh = os.open(self._path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        except OSError as error:  # Windows does not rename open files; the log goes on growing
            self._on_loss(f"it cannot be rotated: {error.strerror}")
            return
        # The descriptors keep their numbers, which C code, `faulthandler` and child processes use.
        os.dup2(fresh, 1)
        os.dup2(fresh, 2)
        os.close(fresh)


def write_to(path: str, on_loss: Callable[[str], object]) -> None:
    """Bound the size of the log that this process's standard output and error already go to."""
    raw = LogFile(path, on_loss)
    for name in ("stdout", "stderr"):
        getattr(sys, name).flush()
        buffer = io.BufferedWriter(raw)
        setattr(sys, name, io.TextIOWrapper(buffer, "utf-8", "backslashreplace", line_buffering=True))
