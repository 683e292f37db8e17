"""How a supervisor starts and ends the processes of its graph: what it asks, whichever way that goes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol

Heard = Callable[[dict[str, Any]], None]
"""Called with what happens to workers:

    {"event": "spawned", "process": ..., "pid": ...}
    {"event": "ready", "process": ..., "node": ...}
    {"event": "failed", "process": ..., "error": ...}
    {"event": "exited", "process": ..., "status": ...}     as subprocess gives it: negative for a signal
"""


class Starter(Protocol):
    """Starts workers and ends them. Made before the loop runs."""

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        """Have node classes imported, in a process of their own."""

    def probed(self) -> dict[str, Any]:
        """What they declare, as `classes.interfaces` gives it. Blocks until it is known.

        Raises:
            SupervisorError: The process that was to import them died.
        """

    async def open(self, log: Path, heard: Heard, lost: Callable[[], None]) -> None:
        """Tell of workers from now on, and of their own end if that comes first.

        Args:
            log: Where troubles of the starter itself are written.
        """

    def spawn(self, process: str, job: dict[str, Any], log: str, env: dict[str, str]) -> None:
        """Start a worker.

        Args:
            job: See `worker.main`.
            log: The file that its output is appended to.
            env: Variables it has beside the supervisor's own.
        """

    def terminate(self, process: str, pid: int) -> None:
        """Ask a worker to end."""

    def kill(self, process: str, pid: int) -> None:
        """End a worker at once, and what it has started."""

    async def close(self) -> None:
        """Tell no more."""

    def end(self) -> None:
        """Give everything back, after the loop has ended."""
