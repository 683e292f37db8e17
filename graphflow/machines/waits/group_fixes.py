"""Fixes: changes of groups that end a deadlock and that a command can apply while the graph runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from graphflow.machines.regrouping import THREADS, Regrouping
from graphflow.machines.waits.group_moves import Move, Request, Setting, moves
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, Edge
from graphflow.machines.waits.wait_graph import GroupView, SetBy, WaitGraph


class Limit(NamedTuple):
    """The fix that allows more runs at a time in a group."""

    node: str
    group: str
    limit: int

    @property
    def handlers(self) -> tuple[str, ...]:
        """Handlers that change their group: none."""
        return ()

    @property
    def settings(self) -> dict[str, Setting]:
        """Settings of the group, as in a graph file."""
        return {"limit": self.limit}

    @property
    def command(self) -> str:
        """Shell command that applies the fix."""
        return f"graphflow groups limit {self.node} {self.group} {self.limit}"

    @property
    def title(self) -> str:
        """Imperative phrase for the fix."""
        return f"allow {self.limit} runs at a time in group '{self.group}' of {self.node}"

    @property
    def requests(self) -> list[Request]:
        """Requests that apply it to the node: see `deadlock.inspection`."""
        return [{"node": self.node, "group": self.group, "limit": self.limit}]

    @property
    def caution(self) -> str:
        """Caution for the user."""
        return "if its handlers share no state"

    def made_in(self, regrouping: Regrouping) -> Regrouping:
        """Return the node's groups with the fix applied, for the graph file."""
        return regrouping.limited(self.group, self.limit)


class Thread(NamedTuple):
    """The fix that runs handlers which block the event loop in threads; it restarts their node."""

    node: str
    handlers: tuple[str, ...]

    @property
    def group(self) -> str:
        """Name of the group that the handlers move to."""
        return THREADS

    @property
    def settings(self) -> dict[str, Setting]:
        """Settings of the group, as in a graph file."""
        return {"thread": True}

    @property
    def command(self) -> str:
        """Shell command that applies the fix."""
        return f"graphflow groups thread {self.node} {' '.join(self.handlers)}"

    @property
    def title(self) -> str:
        """Imperative phrase for the fix."""
        threads = "a thread" if len(self.handlers) == 1 else "threads"
        return f"run {' and '.join(self.handlers)} of {self.node} in {threads}"

    @property
    def caution(self) -> str:
        """Caution for the user."""
        return "starts the node again"

    def made_in(self, regrouping: Regrouping) -> Regrouping:
        """Return the node's groups with the fix applied, for the graph file."""
        return regrouping.in_threads(self.handlers)


Fix = Move | Limit | Thread


def fixes(deadlock: Deadlock, graph: WaitGraph) -> list[Fix]:
    """Return the fixes after each of which the ring can proceed, the least invasive first."""
    return [*moves(deadlock, graph), *_limits(deadlock, graph), *_threads(deadlock, graph)]


def larger(edge: Edge, graph: WaitGraph) -> Limit | None:
    """Return the fix that makes room for one more run; None if no limit of a group causes the edge."""
    group = graph.groups.get(edge.group)
    if group is None or not group.name or group.sort or group.limit is None or isinstance(edge.via, SetBy):
        return None
    return Limit(group.node, group.name, sum(group.id in a.holds for a in graph.activities.values()) + 1)


def _limits(deadlock: Deadlock, graph: WaitGraph) -> Iterator[Limit]:
    found = []
    for edge in deadlock.edges:
        limit = None if edge.loop else larger(edge, graph)
        if limit is not None and limit not in found and _ends(deadlock, limit, graph.groups[edge.group], graph):
            found.append(limit)
    yield from found


def _ends(deadlock: Deadlock, limit: Limit, group: GroupView, graph: WaitGraph) -> bool:
    changed = replace(graph, groups={**graph.groups, group.id: replace(group, limit=limit.limit)})
    return group.is_declared and not set(deadlock.ring) & deadlocked(changed)


def _threads(deadlock: Deadlock, graph: WaitGraph) -> Iterator[Thread]:
    blockers = (graph.activities[edge.to] for edge in deadlock.edges if edge.loop)
    queues = {(queue.node, queue.handler): queue for queue in graph.queues.values()}
    for blocker in {blocker.id: blocker for blocker in blockers}.values():
        queue = queues.get((blocker.node, blocker.handler))
        if queue is not None and queue.is_declared and not blocker.is_async:
            yield Thread(blocker.node, (blocker.handler,))
