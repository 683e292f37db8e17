"""Why activities are dead: the rings in which they wait for each other, and what waits behind them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice

from graphflow.machines.waits.reduction import Dead, Index, reduced
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    WaitGraph,
)

STARTS = 32
"""Activities of one deadlock from which to look for a ring, at most."""


@dataclass(frozen=True, slots=True)
class Edge:
    """Why one activity cannot proceed before another does."""

    to: str
    """The activity that is waited for."""
    via: Condition
    queue: str = ""
    """The queue that the call is in."""
    group: str = ""
    """The group whose slot is missing."""
    loop: bool = False
    """Whether the other activity blocks the event loop."""


@dataclass(frozen=True, slots=True)
class Deadlock:
    """Activities that wait for each other in a ring, and those that wait for them."""

    ring: tuple[str, ...]
    """Each waits for the next, and the last for the first."""
    edges: tuple[Edge, ...]
    """`edges[i]` is why `ring[i]` waits for the next."""
    victims: tuple[str, ...]
    """Dead activities outside the ring that wait for it and are in no deadlock that would remain without it."""
    is_likely: bool
    """Whether the deadlock is certain only if the source code shows everything that sets what a member waits for."""
    is_partial: bool = False
    """Whether the failure of something alive, one of several things waited for, could still end the deadlock."""
    beside: Mapping[str, tuple[Edge, ...]] = field(default_factory=dict)
    """Further conditions of the same `await` that cannot come true either, by member."""


def explained(graph: WaitGraph, dead: Iterable[str]) -> list[Deadlock]:
    """The deadlocks among dead activities, those that have lasted longest first, and what waits for each.

    Each would remain if all the others were fixed.
    """
    index = Index(graph)
    guess_free = Index(graph, may_guess=False)
    waits = _Waits(index, dead)
    firm = reduced(Index(graph, may_fail=True), waits.dead.activities)
    knots = [reduced(index, knot & waits.dead.activities) for knot in _knots(waits.dead.activities, waits.after)]
    alone = set[str]().union(*knots)
    found: list[tuple[float, Deadlock]] = []
    for stuck in filter(None, knots):  # of the others, each only waits for another
        certain = reduced(guess_free, stuck)
        inner = _Waits(guess_free, certain) if certain else _Waits(index, stuck)
        ring = inner.ring()
        members = {name for name, _ in ring}
        behind = sorted(waits.behind(stuck, alone) - members)
        victims = tuple(name for name in behind if not graph.activities[name].is_inner)
        names, edges = tuple(name for name, _ in ring), tuple(edge for _, edge in ring)
        age = max(graph.activities[name].age for name in members)
        beside = {name: others for name, edge in ring if (others := inner.beside(name, edge))}
        found.append((age, Deadlock(names, edges, victims, not certain, not members <= firm, beside)))
    return [deadlock for _, deadlock in sorted(found, key=lambda pair: (-pair[0], pair[1].ring))]


def is_ring(names: Sequence[str], graph: WaitGraph, dead: Iterable[str]) -> bool:
    """Whether each of these waits for the next, and the last for the first, for whatever reason; and all are dead."""
    waits = _Waits(Index(graph), dead)
    return all(waits.leads(here, there) for here, there in zip(names, [*names[1:], names[0]], strict=True))


class _Waits:
    """The wait-for graph of dead activities.

    The way from one that wants a slot to those that hold it leads through the group: there may be many on both sides.
    """

    def __init__(self, index: Index, dead: Iterable[str]) -> None:
        self._index, self.dead = index, Dead(index, dead)
        self._activities = index.graph.activities
        self._edges = {name: list(self._of(self._activities[name])) for name in self.dead.activities}

    @cached_property
    def _before(self) -> dict[str, list[str]]:
        """The reverse of `after`."""
        found: dict[str, list[str]] = {}
        for thing in (*self._edges, *self.dead.groups):
            for other in self.after(thing):
                found.setdefault(other, []).append(thing)
        return found

    def after(self, thing: str) -> Sequence[str]:
        """What an activity waits for, activities and groups; for a group, what holds its slots."""
        if thing in self._edges:
            return [edge.to for edge in self._edges[thing]]
        return self._index.holders[thing]

    def leads(self, here: str, there: str) -> bool:
        """Whether one dead activity cannot proceed before another does."""
        edges = self._edges.get(here, ())
        return any(there == edge.to or (edge.group and there in self._index.holders[edge.group]) for edge in edges)

    def behind(self, members: set[str], others: set[str]) -> set[str]:
        """The activities that wait for any of them, directly or through others, except `others`."""
        found, todo = set(members), list(members)
        while todo:
            new = [thing for thing in self._before.get(todo.pop(), ()) if thing not in found and thing not in others]
            found.update(new)
            todo += new
        return found & self.dead.activities

    def beside(self, name: str, chosen: Edge) -> tuple[Edge, ...]:
        """Why an activity cannot proceed besides one reason: an edge for each other thing that it waits for."""
        others = {edge.via: edge for edge in self._edges[name] if edge.via != chosen.via and not edge.loop}
        holders = self._index.holders
        return tuple(replace(e, to=min(holders[e.group])) if e.group else e for e in others.values())

    def ring(self) -> list[tuple[str, Edge]]:
        """A ring through some of them, the shortest through one, beginning with the one that has waited longest.

        Every process must choose the same: so the choice depends on ids, not on ages, and a ring within one process,
        which that process sees by itself, comes before one through several.
        """
        rings = islice(filter(None, map(self._ring_of, sorted(self._edges))), STARTS)
        ring = min(rings, key=lambda ring: len({self._activities[name].process for name, _ in ring}))
        first = max(range(len(ring)), key=lambda i: self._activities[ring[i][0]].age)
        return ring[first:] + ring[:first]

    def _ring_of(self, start: str) -> list[tuple[str, Edge]]:
        came: dict[str, tuple[str, Edge]] = {}
        seen: set[str] = set()
        todo = deque([start])
        while todo and start not in came:
            here = todo.popleft()
            for edge in self._edges[here]:
                if edge.to in seen:
                    continue
                seen.add(edge.to)
                for other in sorted(self._index.holders[edge.group]) if edge.group else (edge.to,):
                    if other not in came:
                        came[other] = here, replace(edge, to=other)
                        todo.append(other)
        ring: list[tuple[str, Edge]] = []
        while start in came and (not ring or ring[-1][0] != start):
            ring.append(came[ring[-1][0] if ring else start])
        return ring[::-1]

    def _of(self, activity: ActivityView) -> Iterator[Edge]:
        blocker = self._index.graph.blocked.get(activity.process)
        if blocker in self.dead.activities and (blocker != activity.id or activity.wait is not FREE):
            yield Edge(blocker, activity.wait, loop=True)
        yield from self._of_condition(activity.wait)

    def _of_condition(self, condition: Condition) -> Iterator[Edge]:
        """Why a condition is not met; the edges to a group stand for one to each that holds a slot of it."""
        index, dead = self._index, self.dead
        if not index.lacking_for(condition, dead):
            return
        match condition:
            case Call(id=call):
                serving, queued = index.ways_of(call)
                yield from (Edge(one, condition) for one in serving)
                for queue in queued:
                    yield from self._of_queue(queue, condition)
            case Slot(group=group):
                yield Edge(group, condition, group=group)
            case Opening(service=service):
                for queue in index.opening[service]:
                    yield from self._of_queue(queue, condition)
            case Join(activity=other):
                yield Edge(other, condition)
            case SetBy(queues=queues, activities=activities):
                for name in queues:
                    yield from self._of_queue(index.graph.queues[name], condition)
                yield from (Edge(other, condition) for other in activities)
            case All(of=conditions) | AnyOf(of=conditions):
                for inner in conditions:
                    yield from self._of_condition(inner)

    def _of_queue(self, queue: QueueView, via: Condition) -> Iterator[Edge]:
        blocker = self._index.graph.blocked.get(queue.process)
        if blocker in self.dead.activities:
            yield Edge(blocker, via, queue.id, loop=True)
        for group in queue.needs:
            if group in self.dead.groups:
                yield Edge(group, via, queue.id, group)


def _knots(starts: Iterable[str], after: Callable[[str], Sequence[str]]) -> Iterator[set[str]]:
    """The sets of things that all lead to each other, that is the strongly connected components.

    Source: Tarjan, "Depth-first search and linear graph algorithms", 1972.
    """
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_: list[str] = []
    """Things whose knot is not known yet, in the order they were met."""
    is_open: set[str] = set()
    for start in starts:
        path: list[tuple[str, Iterator[str]]] = []
        here: str | None = start if start not in number else None
        while here is not None or path:
            if here is not None:
                number[here] = lowest[here] = len(number)
                open_.append(here)
                is_open.add(here)
                path.append((here, iter(after(here))))
            thing, rest = path[-1]
            here = None
            for other in rest:
                if other not in number:
                    here = other
                    break
                if other in is_open:
                    lowest[thing] = min(lowest[thing], number[other])
            if here is not None:
                continue
            path.pop()
            if path:
                lowest[path[-1][0]] = min(lowest[path[-1][0]], lowest[thing])
            if lowest[thing] == number[thing]:
                knot = set[str]()
                while thing not in knot:
                    knot.add(open_.pop())
                is_open -= knot
                yield knot
