"""What processes of this machine cost."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import psutil


class Cost(NamedTuple):
    """What one process costs."""

    pid: int
    cpu: float
    """Of one core, in percent, since the last look; 0 at the first."""
    memory: int
    """Bytes in use (resident)."""
    threads: int
    seconds: float
    """Time on the processor since its start."""
    nodes: list[str]
    """Who lives in it."""


class Costs:
    """Looks at processes again and again."""

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def look(self, owners: Mapping[int, list[str]], *, by_memory: bool = False) -> list[Cost]:
        """The processes that live, the dearest first.

        Args:
            owners: Who lives in each process, by its id.
        """
        self._known = {pid: process for pid, process in self._known.items() if pid in owners}
        found = []
        for pid, nodes in owners.items():
            try:
                process = self._known.setdefault(pid, psutil.Process(pid))
                with process.oneshot():
                    times = process.cpu_times()
                    cost = Cost(
                        pid,
                        process.cpu_percent(None),
                        process.memory_info().rss,
                        process.num_threads(),
                        times.user + times.system,
                        nodes,
                    )
            except psutil.Error:
                self._known.pop(pid, None)
                continue
            found.append(cost)
        return sorted(found, key=lambda cost: (-(cost.memory if by_memory else cost.cpu), cost.pid))
