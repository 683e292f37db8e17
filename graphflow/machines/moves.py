"""Moves of handlers between groups that end a deadlock: what `graphflow groups move` would be told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from graphflow.machines.explain import method_of
from graphflow.machines.reduction import deadlocked
from graphflow.machines.rings import Deadlock
from graphflow.machines.wait_graph import GroupView, QueueView, WaitGraph


class Move(NamedTuple):
    """Give one handler of a node a group of its own."""

    node: str
    handler: str
    group: str

    @property
    def command(self) -> str:
        """The shell command that makes the move."""
        return f"graphflow groups move {self.node} {self.handler} {self.group}"

    @property
    def yaml(self) -> str:
        """What makes it last, for a graph file."""
        return f"{self.node}: {{concurrency: {{{self.group}: [{self.handler}]}}}}"


def moves(deadlock: Deadlock, graph: WaitGraph) -> list[Move]:
    """The moves after each of which the ring can go on, the one that the explanation names first before others."""
    found: list[Move] = []
    for queue in _queues(deadlock, graph):
        handler = method_of(queue.label)
        move = Move(queue.node, handler, f"{handler}_group")
        if move not in found and _ends(deadlock, queue, graph):
            found.append(move)
    return found


def _queues(deadlock: Deadlock, graph: WaitGraph) -> Iterator[QueueView]:
    """Queues in the ring that wait for a named group, of handlers that hold nothing there themselves.

    One that does, because it calls itself in the end, would wait for its own earlier run in the new group, too.
    """
    holders = {(a.node, method_of(a.label)) for a in (graph.activities[name] for name in deadlock.ring)}
    for edge in deadlock.edges:
        queue, group = graph.queues.get(edge.queue), graph.groups.get(edge.group)
        if queue is None or group is None or not group.name or edge.loop or queue.label.startswith("reply "):
            continue
        if (queue.node, method_of(queue.label)) not in holders:
            yield queue


def _ends(deadlock: Deadlock, queue: QueueView, graph: WaitGraph) -> bool:
    """Whether the ring could go on if the handler had a group of its own."""
    own = GroupView(f"{queue.id} alone", "alone", queue.node)
    moved = replace(queue, needs=(own.id,))
    changed = replace(graph, groups={**graph.groups, own.id: own}, queues={**graph.queues, queue.id: moved})
    return not set(deadlock.ring) & set(deadlocked(changed))
