"""Moves of handlers between groups that end a deadlock: what `graphflow groups move` would be told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from graphflow.machines.regrouping import Regrouping
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, Edge
from graphflow.machines.waits.wait_graph import GroupView, QueueView, SetBy, WaitGraph


class Move(NamedTuple):
    """Give some handlers of a node a group of their own, together."""

    node: str
    handlers: tuple[str, ...]
    group: str

    @property
    def command(self) -> str:
        """The shell command that makes the move."""
        return f"graphflow groups move {self.node} {' '.join(self.handlers)} {self.group}"

    @property
    def title(self) -> str:
        """The move in words."""
        own = "a group of its own" if len(self.handlers) == 1 else "a group of their own"
        return f"give {' and '.join(self.handlers)} of {self.node} {own}"

    @property
    def settings(self) -> dict[str, Any]:
        """Settings of the group besides its handlers: none."""
        return {}

    @property
    def requests(self) -> list[dict[str, Any]]:
        """The requests to the node: see `deadlock.inspection`."""
        return [{"node": self.node, "handler": handler, "group": self.group} for handler in self.handlers]

    @property
    def caution(self) -> str:
        """A caution for the user: none."""
        return ""

    def made_in(self, regrouping: Regrouping) -> Regrouping:
        """The node's groups, as a graph file has them with this move."""
        return regrouping.moved(self.handlers, self.group)


def moves(deadlock: Deadlock, graph: WaitGraph) -> list[Move]:
    """The moves after each of which the ring can go on; first those after which the least of the rest is stuck."""
    found: dict[Move, int] = {}
    for queues in _kept_out(deadlock, graph):
        handlers = tuple(dict.fromkeys(queue.handler for queue in queues))
        left = _left(queues, graph)
        if not left & set(deadlock.ring):
            found.setdefault(Move(queues[0].node, handlers, f"{handlers[0]}_group"), len(left))
    return sorted(found, key=lambda move: found[move])


def _kept_out(deadlock: Deadlock, graph: WaitGraph) -> Iterator[list[QueueView]]:
    """For each member of the ring that waits for a named group: the queues that would let it go on."""
    holders = {(graph.activities[name].node, graph.activities[name].handler) for name in deadlock.ring}
    for name, edge in zip(deadlock.ring, deadlock.edges, strict=True):
        ways = [_movable(each, holders, graph) for each in (edge, *deadlock.beside.get(name, ()))]
        if not all(ways):
            continue
        by_node: dict[str, list[QueueView]] = {}
        for queue in (queue for way in ways for queue in way):
            by_node.setdefault(queue.node, []).append(queue)
        if len(by_node) == 1:
            yield from by_node.values()


def _movable(edge: Edge, holders: set[tuple[str, str]], graph: WaitGraph) -> list[QueueView]:
    """The queues that would let a member of a ring go on, if what they wait for is a named group."""
    group = graph.groups.get(edge.group)
    if edge.loop or group is None or not group.name or group.sort:
        return []
    queues = [queue for queue in queues_of(edge, graph) if not queue.has_answers]
    # One that holds a slot itself, since it waits for itself in the end, would wait for its own run there, too.
    return [queue for queue in queues if (queue.node, queue.handler) not in holders]


def queues_of(edge: Edge, graph: WaitGraph) -> list[QueueView]:
    """The queues whose handlers an activity waits for: the one of its call, or of all that set what it looks at."""
    names = edge.via.queues if isinstance(edge.via, SetBy) else (edge.queue,)
    return [graph.queues[name] for name in names if name in graph.queues]


def _left(queues: list[QueueView], graph: WaitGraph) -> set[str]:
    """What would still be stuck if these handlers had a group of their own."""
    own = GroupView(f"{queues[0].id} alone", "alone", queues[0].node)
    moved = {queue.id: replace(queue, needs=(own.id,)) for queue in queues}
    changed = replace(graph, groups={**graph.groups, own.id: own}, queues={**graph.queues, **moved})
    return deadlocked(changed)
