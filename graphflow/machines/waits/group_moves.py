"""Moves: handlers that go to a group of their own and so end a deadlock, as `graphflow groups move` applies them.

Each candidate is tested by reducing the changed graph. A move counts only if no member of the ring stays dead.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple, TypeAlias

from graphflow.machines.regrouping import Regrouping
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, Edge
from graphflow.machines.waits.wait_graph import GroupView, QueueView, SetBy, WaitGraph

Setting: TypeAlias = "int | bool"
"""Value of one setting of a group."""
Request: TypeAlias = "dict[str, str | int]"
"""Request to change a group: see `deadlock.inspection`."""


class Move(NamedTuple):
    """The fix that gives some handlers of a node a common group of their own."""

    node: str
    handlers: tuple[str, ...]
    group: str

    @property
    def command(self) -> str:
        """Shell command that applies the move."""
        return f"graphflow groups move {self.node} {' '.join(self.handlers)} {self.group}"

    @property
    def title(self) -> str:
        """Imperative phrase for the move."""
        own = "a group of its own" if len(self.handlers) == 1 else "a group of their own"
        return f"give {' and '.join(self.handlers)} of {self.node} {own}"

    @property
    def settings(self) -> dict[str, Setting]:
        """Settings of the group besides its handlers: none."""
        return {}

    @property
    def requests(self) -> list[Request]:
        """Requests that apply it to the node: see `deadlock.inspection`."""
        return [{"node": self.node, "handler": handler, "group": self.group} for handler in self.handlers]

    @property
    def caution(self) -> str:
        """Caution for the user: none."""
        return ""

    def made_in(self, regrouping: Regrouping) -> Regrouping:
        """Return the node's groups with the move applied, for the graph file."""
        return regrouping.moved(self.handlers, self.group)


def moves(deadlock: Deadlock, graph: WaitGraph) -> list[Move]:
    """Return the moves after each of which the ring can proceed, those that free the most others first."""
    found: dict[Move, int] = {}
    for queues in _kept_out(deadlock, graph):
        handlers = tuple(dict.fromkeys(queue.handler for queue in queues))
        left = _left(queues, graph)
        if not left & set(deadlock.ring):
            found.setdefault(Move(queues[0].node, handlers, f"{handlers[0]}_group"), len(left))
    return sorted(found, key=lambda move: found[move])


def _kept_out(deadlock: Deadlock, graph: WaitGraph) -> Iterator[list[QueueView]]:
    """Yield, for each member of the ring that waits for a named group, the queues whose runs would let it proceed."""
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
    """Return the queues whose runs would let a member proceed, if they lack a slot of a named group."""
    group = graph.groups.get(edge.group)
    if edge.loop or group is None or not group.name or group.sort:
        return []
    queues = [queue for queue in queues_of(edge, graph) if not queue.has_answers]
    # A member's own handler would wait for its own run in the new group, too.
    return [queue for queue in queues if (queue.node, queue.handler) not in holders]


def queues_of(edge: Edge, graph: WaitGraph) -> list[QueueView]:
    """Return the queues whose handlers an activity waits for: that of its call, or those of all setters."""
    names = edge.via.queues if isinstance(edge.via, SetBy) else (edge.queue,)
    return [graph.queues[name] for name in names if name in graph.queues]


def _left(queues: list[QueueView], graph: WaitGraph) -> set[str]:
    """Return the activities that would still be dead if these handlers had a group of their own."""
    own = GroupView(f"{queues[0].id} alone", "alone", queues[0].node)
    moved = {queue.id: replace(queue, needs=(own.id,)) for queue in queues}
    changed = replace(graph, groups={**graph.groups, own.id: own}, queues={**graph.queues, **moved})
    return deadlocked(changed)
