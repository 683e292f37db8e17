"""CPU and memory of this machine's processes, each including its descendants."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import psutil


class Cost(NamedTuple):
    """The usage of a process and its descendants, except those that are counted separately."""

    pid: int
    cpu: float
    """Percent of one core since the previous measurement; 0 in the first."""
    memory: int
    """Resident bytes."""
    threads: int
    seconds: float
    """Processor time since its start."""
    nodes: list[str]
    """Full names of its nodes."""
    children: int
    """Number of descendants, which are included."""


class Costs:
    """Repeated measurements of processes."""

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def look(self, owners: Mapping[int, list[str]], *, by_memory: bool = False) -> list[Cost]:
        """Measure the processes that are alive, the busiest first.

        Args:
            owners: Nodes in each process, by process id.
            by_memory: Whether to sort by memory, not by CPU.
        """
        children: dict[int, list[int]] = {}
        if owners:
            for process in psutil.process_iter(["ppid"]):
                children.setdefault(process.info["ppid"], []).append(process.pid)
        trees = {pid: list(_process_tree(pid, children, owners)) for pid in owners}
        alive = {member for tree in trees.values() for member in tree}
        self._known = {pid: process for pid, process in self._known.items() if pid in alive}
        found = []
        for pid, nodes in owners.items():
            costs = [cost for member in trees[pid] if (cost := self._cost(member)) is not None]
            if costs and costs[0].pid == pid:
                cpu, seconds = sum(cost.cpu for cost in costs), sum(cost.seconds for cost in costs)
                memory, threads = sum(cost.memory for cost in costs), sum(cost.threads for cost in costs)
                found.append(Cost(pid, cpu, memory, threads, seconds, nodes, len(costs) - 1))
        return sorted(found, key=lambda cost: (-(cost.memory if by_memory else cost.cpu), cost.pid))

    def _cost(self, pid: int) -> Cost | None:
        """Measure one process alone; None if it has ended."""
        try:
            # psutil computes the CPU share since the previous call on the same object, so the objects are kept.
            process = self._known.setdefault(pid, psutil.Process(pid))
            with process.oneshot():
                times, memory = process.cpu_times(), process.memory_info().rss
                cpu, threads = process.cpu_percent(None), process.num_threads()
        except psutil.Error:
            self._known.pop(pid, None)
            return None
        return Cost(pid, cpu, memory, threads, times.user + times.system, [], 0)


def _process_tree(pid: int, children: Mapping[int, list[int]], owners: Mapping[int, list[str]]) -> Iterator[int]:
    """Yield a process and its descendants, except below processes that are owners themselves."""
    yield pid
    for child in children.get(pid, ()):
        if child not in owners:
            yield from _process_tree(child, children, owners)
