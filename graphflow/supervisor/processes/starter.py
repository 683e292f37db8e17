"""How a supervisor starts and ends the processes of its graph, whichever way that is done."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

Heard = Callable[[dict[str, Any]], None]
"""Called with what happens to workers:

    {"event": "spawned", "process": ..., "pid": ...}
    {"event": "ready", "process": ..., "node": ...}
    {"event": "lifecycle", "process": ..., "node": ..., "state": ...}   of a lifecycle node that runs
    {"event": "debugging", "process": ..., "port": ...}    it waits for a debugger there
    {"event": "beat", "process": ...}                      its event loop goes round
    {"event": "obeyed", "process": ..., "order": ..., "node": ..., "number": ..., "error": ...}   see `orders`
    {"event": "joined", "process": ..., "node": {...}, "number": ...}   and "left": see `container`
    {"event": "failed", "process": ..., "error": ...}
    {"event": "log_lost", "process": ..., "why": ...}
    {"event": "exited", "process": ..., "status": ...}     as subprocess gives it: negative for a signal; None: unknown
"""


class Start(NamedTuple):
    """One process that is to be started, as `Starter.spawn` takes it."""

    process: str
    job: dict[str, Any]
    """See `worker.main`."""
    log: str
    """The file that its output is appended to."""
    env: dict[str, str]
    """Variables it gets besides the supervisor's own."""


class Starter(Protocol):
    """Starts workers and ends them. Made before the loop runs."""

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        """Start importing node classes, in a process of their own."""

    def probed(self) -> dict[str, Any]:
        """What those classes declare, as `classes.interfaces` returns it. Blocks until it is known.

        Raises:
            SupervisorError: The process that should import them died.
        """

    def begin(self, starts: Iterable[Start]) -> None:
        """Start workers before `open`, where that is possible. The first `spawn` of each starts nothing more, and what
        has become of it is told from then on; those that are never asked for end with the starter.
        """

    async def open(self, log: Path, heard: Heard, lost: Callable[[str], None]) -> None:
        """Report on workers from now on, and on the starter's own end if that comes first.

        Args:
            log: The file for the starter's own errors.
            lost: Called with what has happened to the starter; the ends of all workers follow.
        """

    def trouble(self) -> str:
        """Why what is asked of it takes no effect now; empty if it does."""

    def spawn(self, process: str, job: dict[str, Any], log: str, env: dict[str, str]) -> None:
        """Start a worker.

        Args:
            job: See `worker.main`.
            log: The file that its output is appended to.
            env: Variables it gets besides the supervisor's own.
        """

    def tell(self, process: str, order: dict[str, Any]) -> None:
        """Give a worker that is ready an order: see `orders`."""

    def terminate(self, process: str, pid: int) -> None:
        """Ask a worker to end."""

    def kill(self, process: str, pid: int) -> None:
        """End a worker at once, with what it has started."""

    async def close(self) -> None:
        """Stop reporting."""

    def end(self) -> None:
        """Release everything, after the loop has ended."""
