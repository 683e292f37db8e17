"""The cost of processes of this machine, each together with those that it has started."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import psutil


class Cost(NamedTuple):
    """The cost of one process and of those below it, but for the ones that have costs of their own."""

    pid: int
    cpu: float
    """Of one core, in percent, since the last look; 0 at the first."""
    memory: int
    """Bytes in use (resident)."""
    threads: int
    seconds: float
    """Time on the processor since its start."""
    nodes: list[str]
    """Full names of the nodes in it."""
    children: int
    """Processes below it, whose costs are among these."""


class Costs:
    """Looks at processes again and again."""

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def look(self, owners: Mapping[int, list[str]], *, by_memory: bool = False) -> list[Cost]:
        """The processes that live, the dearest first.

        Args:
            owners: Nodes in each process, by its id.
            by_memory: Whether the dearest are those with the most memory; else with the most processor time.
        """
        children: dict[int, list[int]] = {}
        if owners:
            for process in psutil.process_iter(["ppid"]):
                children.setdefault(process.info["ppid"], []).append(process.pid)
        families = {pid: list(_family(pid, children, owners)) for pid in owners}
        alive = {member for family in families.values() for member in family}
        self._known = {pid: process for pid, process in self._known.items() if pid in alive}
        found = []
        for pid, nodes in owners.items():
            costs = [cost for member in families[pid] if (cost := self._cost(member)) is not None]
            if costs and costs[0].pid == pid:
                cpu, seconds = sum(cost.cpu for cost in costs), sum(cost.seconds for cost in costs)
                memory, threads = sum(cost.memory for cost in costs), sum(cost.threads for cost in costs)
                found.append(Cost(pid, cpu, memory, threads, seconds, nodes, len(costs) - 1))
        return sorted(found, key=lambda cost: (-(cost.memory if by_memory else cost.cpu), cost.pid))

    def _cost(self, pid: int) -> Cost | None:
        """The cost of one process alone; None for one that is gone."""
        try:
            process = self._known.setdefault(pid, psutil.Process(pid))
            with process.oneshot():
                times, memory = process.cpu_times(), process.memory_info().rss
                cpu, threads = process.cpu_percent(None), process.num_threads()
        except psutil.Error:
            self._known.pop(pid, None)
            return None
        return Cost(pid, cpu, memory, threads, times.user + times.system, [], 0)


def _family(pid: int, children: Mapping[int, list[int]], owners: Mapping[int, list[str]]) -> Iterator[int]:
    """A process and those below it, but for the ones that are owners themselves."""
    yield pid
    for child in children.get(pid, ()):
        if child not in owners:
            yield from _family(child, children, owners)
