"""The interface of starters, which start and end the processes of a graph: by forking, or portably."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from graphflow.system import is_portable

if TYPE_CHECKING:
    from graphflow.supervisor.processes.jobs import Start
    from graphflow.supervisor.processes.messages import InterfacesJson, Job, Order, ProcessEvent


class Starter(Protocol):
    """Starts workers and foreign programs, and ends them. Made before the loop runs."""

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        """Start importing node classes, in a process of their own."""

    def probed(self) -> InterfacesJson:
        """Return the interfaces of those classes. Blocks until they are known.

        Raises:
            SupervisorError: The process that should import them died.
        """

    def begin(self, starts: Iterable[Start]) -> None:
        """Start workers before `open`, where that is possible.

        The first `spawn` of each starts nothing more and passes on the events so far. Those that are never spawned end
        with the starter.
        """

    async def open(self, log: Path, on_event: Callable[[ProcessEvent], None], lost: Callable[[str], None]) -> None:
        """Report events of workers from now on, and the starter's own end if that comes first.

        Args:
            log: The file for the starter's own errors.
            lost: Called with the starter's end in words; the ends of all workers follow.
        """

    def trouble(self) -> str:
        """Return why requests take no effect now; empty if they do."""

    def spawn(self, process: str, job: Job, log: str, env: dict[str, str]) -> None:
        """Start a process.

        Args:
            log: The file that its output is appended to.
            env: Variables it gets besides the supervisor's own.
        """

    def send_order(self, process: str, order: Order) -> None:
        """Give an order to a worker that is ready."""

    def terminate(self, process: str, pid: int) -> None:
        """Ask a process to end."""

    def kill(self, process: str, pid: int) -> None:
        """End a process at once, with all that it has started."""

    async def close(self) -> None:
        """Stop reporting."""

    def end(self) -> None:
        """Release everything, after the loop has ended."""


def make_starter(keep: tuple[int, ...]) -> Starter:
    """Create a starter for this system. The process must have one thread.

    Args:
        keep: Descriptors that workers must not inherit.
    """
    # Imported here: each starter needs modules that the other, or the other's systems, do without.
    if is_portable():
        from graphflow.supervisor.processes.spawning import SpawningStarter

        return SpawningStarter()
    from graphflow.supervisor.processes.forking import ForkingStarter

    return ForkingStarter(keep)
