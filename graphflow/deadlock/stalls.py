"""Stalls: groups that the same runs hold for long while other handlers wait; no deadlock, but worth a warning."""

from __future__ import annotations

import logging
from dataclasses import dataclass

from graphflow.machines.waits.explain import stall
from graphflow.machines.waits.wait_graph import ActivityView, QueueView, WaitGraph
from graphflow.times import NANOSECONDS

logger = logging.getLogger("graphflow")

STALL_AFTER = 5.0
"""Seconds for which others must wait before a stall is reported."""
LOOK_EVERY = 1.0
"""Seconds between two checks whether a stall is over."""


@dataclass
class _Stall:
    """A group that the same runs hold while others wait."""

    holders: frozenset[str]
    since_ns: int
    """Time at which something was first seen to wait for them."""
    dropped: dict[str, int]
    """By queue: number of items it had dropped by then."""
    text: str = ""
    """Report; empty until the stall has lasted long enough."""


class Stalls:
    """The stalls of one process. One per process."""

    def __init__(self) -> None:
        self._by_group: dict[str, _Stall] = {}

    @property
    def texts(self) -> list[str]:
        """Reports of the stalls that still last."""
        return [kept.text for kept in list(self._by_group.values()) if kept.text]

    def look(self, graph: WaitGraph, dead: set[str], now_ns: int) -> float | None:
        """Report new stalls, and the ends of reported ones.

        Args:
            dead: Activities that are in a reported deadlock.

        Returns:
            Seconds until the next check; None if no group keeps anything waiting.
        """
        holders: dict[str, list[ActivityView]] = {}
        for activity in graph.activities.values():
            for name in activity.holds:
                holders.setdefault(name, []).append(activity)
        kept: dict[str, _Stall] = {}
        due: list[float] = []
        for name, waiting in _wanted(graph, holders).items():
            by = holders[name]
            if any(a.id in dead for a in by):
                continue
            ids = frozenset(a.id for a in by)
            known = self._by_group.get(name)
            if known is None or known.holders != ids:
                known = _Stall(ids, now_ns, {queue.id: queue.dropped for queue in waiting})
            kept[name] = known
            seconds = (now_ns - known.since_ns) / NANOSECONDS
            if not known.text and seconds >= 0.999 * STALL_AFTER:
                known.text = stall(graph.groups[name], by, waiting, known.dropped, seconds, graph)
                logger.warning("%s", known.text)
            due.append(LOOK_EVERY if known.text else STALL_AFTER - seconds)
        for name, gone in self._by_group.items():
            if gone.text and kept.get(name) is not gone and name in graph.groups:
                group = graph.groups[name]
                seconds = (now_ns - gone.since_ns) / NANOSECONDS
                logger.warning("group '%s' of %s is free again after %.1f s", group.name, group.node, seconds)
        self._by_group = kept
        return min(due, default=None)


def _wanted(graph: WaitGraph, holders: dict[str, list[ActivityView]]) -> dict[str, list[QueueView]]:
    """Return the full groups that users named, with the queues of handlers that want a slot and hold none."""
    found: dict[str, list[QueueView]] = {}
    for queue in graph.queues.values():
        for name in queue.needs if queue.waiting else ():
            group, by = graph.groups[name], holders.get(name, [])
            is_full = group.limit is not None and len(by) >= group.limit
            # Runs of one handler that queue for each other are the purpose of a group, not a stall.
            if group.name and not group.sort and is_full and any(a.label != queue.label for a in by):
                found.setdefault(name, []).append(queue)
    return found
