"""Who waits for whom, as one picture of a graph, and which of them can never go on.

The picture holds *activities* (runs of handlers and tasks under way), the *groups* whose slots they hold, and the
*queues* of handlers. An activity that waits does so for a call, for a slot, for another activity, for something that
only certain handlers set, or for all or any of several such things.

`deadlocked` is Holt's reduction: whoever may go on goes on and gives everything back, until nobody is left who can.
It is optimistic: what the picture does not show may go on. So what remains cannot, whatever happens outside.

Pictures of several processes are not taken at one moment. An activity counts as stuck only if it was seen in the very
same wait in a picture that was complete before the present one was begun: ids are never used twice, so there was a
moment between the two at which all the waits that are left existed together.

Source: Holt, "Some deadlock properties of computer systems", 1972.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from graphflow.errors import Place


@dataclass(frozen=True, slots=True)
class Call:
    """Wait for the answer to a call, or for the end of a goal."""

    id: str
    name: str
    """Of the service or action."""


@dataclass(frozen=True, slots=True)
class Slot:
    """Wait for a slot of a group, to come back to it."""

    group: str
    ticket: int


@dataclass(frozen=True, slots=True)
class Join:
    """Wait for the end of another activity."""

    activity: str


@dataclass(frozen=True, slots=True)
class SetBy:
    """Wait for something that, as far as the source code tells, only these handlers and activities bring about."""

    what: str
    """In words: `self.arrived`."""
    queues: tuple[str, ...]
    activities: tuple[str, ...] = ()
    is_held: bool = False
    """Whether it is a lock or its like, which those activities hold."""


@dataclass(frozen=True, slots=True)
class All:
    """Wait for every one of these."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """Wait for one of these, whichever."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class Free:
    """Wait for what the picture does not show: time, a thread, the outside world."""


FREE = Free()
Condition = Call | Slot | Join | SetBy | All | AnyOf | Free


@dataclass(frozen=True, slots=True)
class Activity:
    """A run of a handler, or a task."""

    id: str
    label: str
    """Method and kind: `tick`, `service add`."""
    node: str
    holds: tuple[str, ...] = ()
    """The groups of which it holds a slot."""
    wait: Condition = FREE
    serves: str = ""
    """The call or goal that it answers."""
    place: Place = field(default_factory=lambda: Place(""))
    """Where it waits."""
    function: str = ""
    age: float = 0.0
    """Seconds that it has waited."""
    left: float | None = None
    """Seconds until its call times out; None if never."""
    process: str = ""
    is_inner: bool = False
    """Whether it is graphflow's, and nothing that users have written."""


@dataclass(frozen=True, slots=True)
class Group:
    """A concurrency group of a node, or a handler's own queue, which is as good as a group of its own."""

    id: str
    name: str
    """Empty for a handler's own queue."""
    node: str
    limit: int | None = 1


@dataclass(frozen=True, slots=True)
class Queue:
    """What waits to be handled by one handler."""

    id: str
    label: str
    node: str
    needs: tuple[str, ...]
    """The groups of which the next run takes a slot."""
    calls: tuple[str, ...] = ()
    """Calls and goals that wait, in order."""
    waiting: int = 0
    """Items that wait, of whatever kind."""
    dropped: int = 0
    process: str = ""


@dataclass(frozen=True, slots=True)
class Picture:
    """Who waits for whom in one process, or in several."""

    activities: Mapping[str, Activity] = field(default_factory=dict)
    groups: Mapping[str, Group] = field(default_factory=dict)
    queues: Mapping[str, Queue] = field(default_factory=dict)
    blocked: Mapping[str, str] = field(default_factory=dict)
    """By process whose loop is blocked: the activity that blocks it."""


def joined(pictures: Iterable[Picture]) -> Picture:
    """Several processes as one picture."""
    whole = Picture({}, {}, {}, {})
    for picture in pictures:
        whole = Picture(
            {**whole.activities, **picture.activities},
            {**whole.groups, **picture.groups},
            {**whole.queues, **picture.queues},
            {**whole.blocked, **picture.blocked},
        )
    return whole


@dataclass(frozen=True, slots=True)
class Edge:
    """Why one activity cannot go on before another does."""

    to: str
    """The activity that is waited for."""
    via: Condition
    queue: str = ""
    """In which queue the call stands."""
    group: str = ""
    """Whose slot is missing."""
    loop: bool = False
    """The other blocks the event loop."""


class _Index:
    """A picture by what is looked for.

    Args:
        may_fail: Whether an error of one of several that are waited for may end the wait for all of them.
        may_guess: Whether to believe that nobody brings about what is waited for but those whom the source code shows.
    """

    def __init__(self, picture: Picture, *, may_fail: bool = False, may_guess: bool = True) -> None:
        self.picture = picture
        self._all_of = any if may_fail else all
        self._may_guess = may_guess
        self.holders: dict[str, list[str]] = {}
        self.serving: dict[str, str] = {}
        for activity in picture.activities.values():
            for group in activity.holds:
                self.holders.setdefault(group, []).append(activity.id)
            if activity.serves:
                self.serving[activity.serves] = activity.id
        self.queued = {call: queue for queue in picture.queues.values() for call in queue.calls}

    def is_met(self, condition: Condition, live: set[str]) -> bool:
        """Whether it may be fulfilled if the activities in `live` go on. An activity outside of the picture may."""
        match condition:
            case Call(id=call):
                if call in self.serving:
                    return self.serving[call] in live
                return call not in self.queued or self._may_run(self.queued[call], live)
            case Slot(group=group):
                return self._has_slot(group, live)
            case Join(activity=other):
                return other not in self.picture.activities or other in live
            case SetBy(queues=queues, activities=activities):
                known = [self.picture.queues[q] for q in queues if q in self.picture.queues]
                return (
                    not self._may_guess
                    or len(known) < len(queues)
                    or any(self._may_run(queue, live) for queue in known)
                    or any(other not in self.picture.activities or other in live for other in activities)
                )
            case All(of=conditions):
                return self._all_of(self.is_met(c, live) for c in conditions)
            case AnyOf(of=conditions):
                return any(self.is_met(c, live) for c in conditions)
            case Free():
                return True

    def is_met_outside(self, condition: Condition) -> bool:
        """Whether it may be fulfilled while the event loop, through which all of graphflow comes, is blocked."""
        match condition:
            case SetBy():
                return not self._may_guess
            case All(of=conditions):
                return self._all_of(self.is_met_outside(c) for c in conditions)
            case AnyOf(of=conditions):
                return any(self.is_met_outside(c) for c in conditions)
            case _:
                return condition is FREE

    def _has_slot(self, group: str, live: set[str]) -> bool:
        known = self.picture.groups.get(group)
        if known is None or known.limit is None:
            return True
        holders = self.holders.get(group, [])
        return len(holders) < known.limit or any(holder in live for holder in holders)

    def _may_run(self, queue: Queue, live: set[str]) -> bool:
        blocker = self.picture.blocked.get(queue.process)
        if blocker in self.picture.activities and blocker not in live:
            return False
        return all(self._has_slot(group, live) for group in queue.needs)

    def loop_of(self, activity: Activity) -> str | None:
        """The activity that blocks this one's event loop, if another does."""
        blocker = self.picture.blocked.get(activity.process)
        return None if blocker == activity.id else blocker

    def edges(self, activity: Activity, dead: set[str]) -> Iterator[Edge]:
        """Which dead activities this one waits for."""
        blocker = self.picture.blocked.get(activity.process)
        if blocker in dead and (blocker != activity.id or activity.wait is not FREE):
            yield Edge(blocker, activity.wait, loop=True)
        yield from self._edges(activity.wait, dead)

    def _edges(self, condition: Condition, dead: set[str]) -> Iterator[Edge]:
        match condition:
            case Call(id=call):
                if self.serving.get(call) in dead:
                    yield Edge(self.serving[call], condition)
                elif call in self.queued:
                    queue = self.queued[call]
                    blocker = self.picture.blocked.get(queue.process)
                    if blocker in dead:
                        yield Edge(blocker, condition, queue.id, loop=True)
                    for group in queue.needs:
                        yield from self._slot_edges(group, condition, dead, queue.id)
            case Slot(group=group):
                yield from self._slot_edges(group, condition, dead)
            case Join(activity=other):
                if other in dead:
                    yield Edge(other, condition)
            case SetBy(queues=queues, activities=activities):
                for name in queues:
                    if name in self.picture.queues:
                        for group in self.picture.queues[name].needs:
                            yield from self._slot_edges(group, condition, dead, name)
                for other in activities:
                    if other in dead:
                        yield Edge(other, condition)
            case All(of=conditions) | AnyOf(of=conditions):
                live = set(self.picture.activities) - dead
                for inner in conditions:
                    if not self.is_met(inner, live):
                        yield from self._edges(inner, dead)
            case Free():
                return

    def _slot_edges(self, group: str, via: Condition, dead: set[str], queue: str = "") -> Iterator[Edge]:
        if self._has_slot(group, set(self.picture.activities) - dead):
            return
        for holder in self.holders.get(group, []):
            if holder in dead:
                yield Edge(holder, via, queue, group)


def deadlocked(picture: Picture, before: Picture | None = None) -> set[str]:
    """The activities that can never take another step, whatever happens outside of the picture.

    Args:
        before: A picture that was complete before this one was begun; None when this one was taken at one moment.
    """
    index = _Index(picture)
    activities = picture.activities
    if before is None:
        suspects = {a.id for a in activities.values() if a.wait is not FREE or index.loop_of(a)}
    else:
        suspects = {a.id for a in activities.values() if _is_same(a, before.activities.get(a.id))}
        suspects = {i for i in suspects if activities[i].wait is not FREE or index.loop_of(activities[i])}
    return _reduced(index, suspects)


def _reduced(index: _Index, suspects: Iterable[str]) -> set[str]:
    """Those of the suspects who cannot go on, however the others do."""
    left = set(suspects)
    activities = index.picture.activities
    live = set(activities) - left
    while moving := {i for i in left if _may_go_on(index, activities[i], live)}:
        left -= moving
        live |= moving
    return left


def _is_same(now: Activity, then: Activity | None) -> bool:
    return then is not None and (now.wait, now.holds, now.serves) == (then.wait, then.holds, then.serves)


def _may_go_on(index: _Index, activity: Activity, live: set[str]) -> bool:
    blocker = index.picture.blocked.get(activity.process)
    if blocker == activity.id:
        return index.is_met_outside(activity.wait)
    if blocker is not None and blocker in index.picture.activities and blocker not in live:
        return False
    return index.is_met(activity.wait, live)


@dataclass(frozen=True, slots=True)
class Deadlock:
    """Activities that wait for each other in a ring, and who waits for them."""

    ring: tuple[str, ...]
    """Each waits for the next, and the last for the first."""
    edges: tuple[Edge, ...]
    """`edges[i]` is why `ring[i]` waits for the next."""
    victims: tuple[str, ...]
    """Dead activities outside of the ring."""
    is_likely: bool
    """It is certain only if nothing but what the source code shows sets what somebody in it or behind it waits for."""
    is_partial: bool = False
    """The failure of something alive, one of several things that are waited for, could still end it."""


def explained(picture: Picture, dead: set[str]) -> list[Deadlock]:
    """The rings in a set of dead activities, each once, and the victims of each."""
    index = _Index(picture)
    certain = _reduced(_Index(picture, may_guess=False), dead)
    firm = _reduced(_Index(picture, may_fail=True), dead)
    edges = {i: list(index.edges(picture.activities[i], dead)) for i in dead}
    found: list[Deadlock] = []
    covered: set[str] = set()
    for start in sorted(dead, key=lambda i: (-picture.activities[i].age, i)):
        if start in covered:
            continue
        ring = _ring(start, edges)
        if ring is None:
            continue
        covered.update(i for i, _ in ring)
        members = {i for i, _ in ring}
        behind = sorted(i for i in dead - members if _reaches(i, members, edges))
        covered.update(behind)
        victims = tuple(i for i in behind if not picture.activities[i].is_inner)
        likely, partial = not members <= certain, not members <= firm
        found.append(Deadlock(tuple(i for i, _ in ring), tuple(e for _, e in ring), victims, likely, partial))
    return found


def _ring(start: str, edges: Mapping[str, list[Edge]]) -> list[tuple[str, Edge]] | None:
    """The first ring that is met on the way from `start`."""
    path: list[tuple[str, Edge]] = []
    seen: set[str] = set()
    here = start
    while edges[here]:
        if here in seen:
            first = next(i for i, (name, _) in enumerate(path) if name == here)
            return path[first:]
        seen.add(here)
        # Towards what has been met already if that is possible: the shortest ring explains best.
        edge = next((e for e in edges[here] if e.to in seen), edges[here][0])
        path.append((here, edge))
        here = edge.to
    return None


def _reaches(start: str, goals: set[str], edges: Mapping[str, list[Edge]]) -> bool:
    todo, seen = [start], {start}
    while todo:
        here = todo.pop()
        if here in goals:
            return True
        new = {edge.to for edge in edges[here]} - seen
        seen |= new
        todo += new
    return False
