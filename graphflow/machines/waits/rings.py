"""The rings in a reduced graph: for each deadlock, one cycle of waits that shows why it exists, and its victims.

The reduction leaves a set of dead activities, which may contain several independent deadlocks and many activities that
only wait behind them. In the graph of the dead, each strongly connected component that stays dead when it is reduced by
itself is a deadlock of its own: it would remain if all others were fixed. Everything else waits behind one.

A component can be large. A report shows one cycle through it, the shortest, because a person can follow that, and
because breaking it is what the remedies are about. Every process must choose the same cycle without talking to the
others, so the choice depends on nothing but ids.
"""

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
"""Activities of one deadlock from which a ring is searched, at most."""


@dataclass(frozen=True, slots=True)
class Edge:
    """The reason why one activity cannot proceed before another does."""

    to: str
    """Id of the activity that is waited for."""
    via: Condition
    """Leaf of the waiter's condition that leads there."""
    queue: str = ""
    """Id of the queue whose next run would meet it."""
    group: str = ""
    """Id of the group of which that run, or the waiter, lacks a slot."""
    loop: bool = False
    """Whether the other activity blocks the event loop."""


@dataclass(frozen=True, slots=True)
class Deadlock:
    """Activities that wait for each other in a ring, and the victims behind them."""

    ring: tuple[str, ...]
    """Members: each waits for the next, and the last for the first."""
    edges: tuple[Edge, ...]
    """Reasons: `edges[i]` is why `ring[i]` waits for the next member."""
    victims: tuple[str, ...]
    """Dead activities outside the ring that wait for it and would proceed if it were broken."""
    is_likely: bool
    """Whether the deadlock rests on the closed-world assumption for some member's wait."""
    is_partial: bool = False
    """Whether an error in another part of a joint wait, a part that is alive, could still end the deadlock."""
    beside: Mapping[str, tuple[Edge, ...]] = field(default_factory=dict)
    """By member: reasons why the other alternatives of the same wait cannot come true either."""


def explained(graph: WaitGraph, dead: Iterable[str]) -> list[Deadlock]:
    """Return the deadlocks among dead activities, the oldest first, each with its victims.

    Each would remain if all the others were fixed. A ring that is certain is preferred to a likely one.
    """
    index = Index(graph)
    guess_free = Index(graph, may_guess=False)
    waits = _Waits(index, dead)
    firm = reduced(Index(graph, may_fail=True), waits.dead.activities)
    components = [
        reduced(index, component & waits.dead.activities)
        for component in _components(waits.dead.activities, waits.after)
    ]
    alone = set[str]().union(*components)
    found: list[tuple[float, Deadlock]] = []
    for stuck in filter(None, components):  # a component that reduces to nothing only waits behind another
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
    """Whether these activities are all dead, and each waits for the next, the last for the first, for any reason."""
    waits = _Waits(Index(graph), dead)
    return all(waits.leads(here, there) for here, there in zip(names, [*names[1:], names[0]], strict=True))


class _Waits:
    """The wait-for graph of dead activities.

    A full group is a vertex of its own between those that want a slot and those that hold one. With n of the former
    and m of the latter that is n + m edges in place of n * m.
    """

    def __init__(self, index: Index, dead: Iterable[str]) -> None:
        self._index, self.dead = index, Dead(index, dead)
        self._activities = index.graph.activities
        self._edges = {name: list(self._of(self._activities[name])) for name in self.dead.activities}

    @cached_property
    def _before(self) -> dict[str, list[str]]:
        """The predecessors of each vertex: the reverse of `after`."""
        found: dict[str, list[str]] = {}
        for thing in (*self._edges, *self.dead.groups):
            for other in self.after(thing):
                found.setdefault(other, []).append(thing)
        return found

    def after(self, thing: str) -> Sequence[str]:
        """Return the successors of a vertex: of an activity what it waits for, of a group its holders."""
        if thing in self._edges:
            return [edge.to for edge in self._edges[thing]]
        return self._index.holders[thing]

    def leads(self, here: str, there: str) -> bool:
        """Whether one dead activity cannot proceed before another does."""
        edges = self._edges.get(here, ())
        return any(there == edge.to or (edge.group and there in self._index.holders[edge.group]) for edge in edges)

    def behind(self, members: set[str], others: set[str]) -> set[str]:
        """Return the members and the activities that wait for them, directly or through any but `others`."""
        found, todo = set(members), list(members)
        while todo:
            new = [thing for thing in self._before.get(todo.pop(), ()) if thing not in found and thing not in others]
            found.update(new)
            todo += new
        return found & self.dead.activities

    def beside(self, name: str, chosen: Edge) -> tuple[Edge, ...]:
        """Return one edge for each other leaf of an activity's condition, besides the edge that is in the ring."""
        others = {edge.via: edge for edge in self._edges[name] if edge.via != chosen.via and not edge.loop}
        holders = self._index.holders
        return tuple(replace(e, to=min(holders[e.group])) if e.group else e for e in others.values())

    def ring(self) -> list[tuple[str, Edge]]:
        """Return the ring to report, beginning with the member that has waited longest.

        Every process must choose the same one, so the choice depends on ids and not on ages, which each process
        measures by itself. A ring within one process comes before one through several, because that process reports it
        without asking the others.
        """
        rings = islice(filter(None, map(self._ring_of, sorted(self._edges))), STARTS)
        ring = min(rings, key=lambda ring: len({self._activities[name].process for name, _ in ring}))
        first = max(range(len(ring)), key=lambda i: self._activities[ring[i][0]].age)
        return ring[first:] + ring[:first]

    def _ring_of(self, start: str) -> list[tuple[str, Edge]]:
        """Return a shortest ring through an activity, by breadth-first search; empty if there is none."""
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
        """Yield an edge for each leaf that is not met; one to a group represents an edge to each of its holders."""
        index, dead = self._index, self.dead
        if not index.lacking_for(condition, dead):
            return
        match condition:
            case Call(id=call):
                serving, queued = index.ways_of(call)
                yield from (Edge(one, condition) for one in serving)
                yield from self._of_queues(queued, condition)
            case Slot(group=group):
                yield Edge(group, condition, group=group)
            case Opening(service=service):
                yield from self._of_queues(index.opening[service], condition)
            case Join(activity=other):
                yield Edge(other, condition)
            case SetBy(queues=names, activities=activities):
                yield from self._of_queues(map(index.graph.queues.__getitem__, names), condition)
                yield from (Edge(other, condition) for other in activities)
            case All(of=conditions) | AnyOf(of=conditions):
                for inner in conditions:
                    yield from self._of_condition(inner)

    def _of_queues(self, queues: Iterable[QueueView], via: Condition) -> Iterator[Edge]:
        """Yield the reasons why no handler of these queues can run."""
        for queue in queues:
            blocker = self._index.graph.blocked.get(queue.process)
            if blocker in self.dead.activities:
                yield Edge(blocker, via, queue.id, loop=True)
            for group in queue.needs:
                if group in self.dead.groups:
                    yield Edge(group, via, queue.id, group)


def _components(starts: Iterable[str], after: Callable[[str], Sequence[str]]) -> Iterator[set[str]]:
    """Yield the strongly connected components that can be reached from some vertices, each before its predecessors.

    Tarjan's algorithm with an explicit stack: chains of waits may be longer than Python's recursion limit.

    Source: Tarjan, "Depth-first search and linear graph algorithms", SIAM Journal on Computing 1 (1972).
    """
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    stack: list[str] = []
    """Vertices whose component is not complete, in the order of discovery."""
    on_stack: set[str] = set()
    for start in starts:
        path: list[tuple[str, Iterator[str]]] = []
        new: str | None = start if start not in number else None
        while new is not None or path:
            if new is not None:
                number[new] = lowest[new] = len(number)
                stack.append(new)
                on_stack.add(new)
                path.append((new, iter(after(new))))
            here, successors = path[-1]
            new = _next_new(here, successors, number, lowest, on_stack)
            if new is not None:
                continue
            path.pop()
            if path:
                above = path[-1][0]
                lowest[above] = min(lowest[above], lowest[here])
            if lowest[here] == number[here]:  # the root of its component, which lies above it on the stack
                component = set[str]()
                while here not in component:
                    component.add(stack.pop())
                on_stack -= component
                yield component


def _next_new(
    here: str, successors: Iterator[str], number: dict[str, int], lowest: dict[str, int], on_stack: set[str]
) -> str | None:
    """Return the next undiscovered successor of a vertex; note in `lowest` how far back the others lead."""
    for other in successors:
        if other not in number:
            return other
        if other in on_stack:
            lowest[here] = min(lowest[here], number[other])
    return None
