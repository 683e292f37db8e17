"""Graph reduction: the activities of a snapshot that can never proceed.

**Why not a search for cycles.** With AND waits alone, a cycle is necessary and sufficient for deadlock; with OR waits
alone, a knot is. Waits here are AND/OR formulas over resources with several units, for which a cycle is necessary but
not sufficient, and neither is a simple property of the graph. Holt's reduction decides the general case.

**The reduction.** Assume every waiting activity is dead. As long as some dead activity's condition can be met by
activities that are not dead, let it proceed: it runs to its end and gives back its slots, which may let others proceed.
The result does not depend on the order, because letting an activity proceed only ever frees more (the set of the dead
shrinks monotonically to the greatest fixed point). The activities that remain are deadlocked: no sequence of
events inside the snapshot lets any of them take another step.

**No false alarm.** Everything that the snapshot does not show is assumed to proceed: time, threads, processes that did
not answer, servers that were not found. So a remaining activity stays stuck whatever happens outside. The one
assumption that could fail is the closed world behind `SetBy`; `Index(may_guess=False)` reduces without it, and a
deadlock that then vanishes is reported as LIKELY.

**Several processes.** Their snapshots are not taken at one moment, so edges that never existed together could form a
phantom cycle. Deadlock is a stable property, hence a second round settles it: an activity counts only if the same wait
was in a snapshot that was complete before the present round began. Ids are never reused and a wait once ended does not
come back, so each of the remaining waits lasted from the end of the first round to the beginning of the second: at any
moment in between all of them existed at once.

Cost: each activity is examined again only after one of the reasons recorded for it has gone.

Source: Holt, "Some deadlock properties of computer systems", ACM Computing Surveys 4 (1972), for the reduction;
Chandy and Lamport, "Distributed snapshots", ACM TOCS 3 (1985), for stable properties.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

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

Lacking = tuple[str, ...]
"""Witnesses that something cannot happen yet: ids of dead activities and of groups whose holders are all dead.

Empty if it may happen now. Otherwise it stays impossible until at least one of them changes."""


class Index:
    """A snapshot indexed for the reduction.

    Args:
        may_fail: Whether an error in one part may end a wait for `All`, which makes it an OR: `gather` and `TaskGroup`
            raise the first error. Activities that are dead even so are stuck for certain.
        may_guess: Whether `SetBy` names everything that could end its wait (the closed-world assumption).
    """

    def __init__(self, graph: WaitGraph, *, may_fail: bool = False, may_guess: bool = True) -> None:
        self.graph = graph
        self.holders: dict[str, list[str]] = {}
        """By group: the activities that hold its slots."""
        self.serving: dict[str, list[str]] = {}
        """By call: the activities that answer it."""
        for activity in graph.activities.values():
            for group in activity.holds:
                self.holders.setdefault(group, []).append(activity.id)
            if activity.serves:
                self.serving.setdefault(activity.serves, []).append(activity.id)
        self.queued: dict[str, list[QueueView]] = {}
        """By call: the queues that it waits in, one per server."""
        for queue in graph.queues.values():
            for call in queue.calls:
                self.queued.setdefault(call, []).append(queue)
        self.opening: dict[str, list[QueueView]] = {}
        """By service: the queues of handlers that will offer it when they may run."""
        for queue in graph.queues.values():
            for service in queue.opens:
                self.opening.setdefault(service, []).append(queue)
        self._all_of = _one_of if may_fail else _each_of
        self._may_guess = may_guess

    def is_full(self, group: str) -> bool:
        """Whether every slot of a group is taken."""
        known = self.graph.groups.get(group)
        return known is not None and known.limit is not None and len(self.holders.get(group, ())) >= known.limit

    def loop_of(self, activity: ActivityView) -> str | None:
        """Return the activity that blocks this one's event loop; None if none does, or it does so itself."""
        blocker = self.graph.blocked.get(activity.process)
        return None if blocker == activity.id else blocker

    def lacking(self, activity: ActivityView, dead: Dead) -> Lacking:
        """Return the reasons why an activity cannot proceed.

        The event loop is a resource like any other: whatever runs on it needs its blocker to return first. The blocker
        itself waits synchronously, so nothing that needs the loop can end its wait.
        """
        blocker = self.graph.blocked.get(activity.process)
        if blocker == activity.id:
            return () if self._is_met_outside(activity.wait) else (activity.id,)
        return self._of(blocker, dead) or self.lacking_for(activity.wait, dead)

    def lacking_for(self, condition: Condition, dead: Dead) -> Lacking:
        """Return the reasons why a condition cannot be met; empty if it may be."""
        match condition:
            case Call(id=call, servers=servers):
                serving, queued = self.ways_of(call)
                if len(serving) + len(queued) < servers and not any(queue.has_answers for queue in queued):
                    return ()  # some server is in no snapshot, and may answer
                ways = [self.lacking_to_run(queue, dead) for queue in queued]
                return _one_of([*(self._of(one, dead) for one in serving), *ways])
            case Slot(group=group):
                return (group,) if group in dead.groups else ()
            case Opening(service=service):
                return _one_of(self.lacking_to_run(queue, dead) for queue in self.opening.get(service, ()))
            case Join(activity=other):
                return self._of(other, dead)
            case SetBy(queues=names, activities=activities) if self._may_guess:
                queues = [self.graph.queues.get(name) for name in names]
                ways = [() if queue is None else self.lacking_to_run(queue, dead) for queue in queues]
                return _one_of([*ways, *(self._of(other, dead) for other in activities)])
            case All(of=conditions):
                return self._all_of(self.lacking_for(c, dead) for c in conditions)
            case AnyOf(of=conditions):
                return _one_of(self.lacking_for(c, dead) for c in conditions)
            case _:
                return ()

    def ways_of(self, call: str) -> tuple[list[str], list[QueueView]]:
        """Return the alternatives for a call to return: an activity that ends, or a queue that is served.

        Once a response waits at the client, only its delivery matters, whatever the servers do.
        """
        queued = self.queued.get(call, [])
        answers = [queue for queue in queued if queue.has_answers]
        return ([], answers) if answers else (self.serving.get(call, []), queued)

    def lacking_to_run(self, queue: QueueView, dead: Dead) -> Lacking:
        """Return the reasons why the next run of a handler cannot begin.

        One group suffices as a reason, since a run needs a slot of every group (an AND).
        """
        blocker = self._of(self.graph.blocked.get(queue.process), dead)
        return blocker or next(((group,) for group in queue.needs if group in dead.groups), ())

    def _of(self, activity: str | None, dead: Dead) -> Lacking:
        return (activity,) if activity is not None and activity in dead.activities else ()

    def _is_met_outside(self, condition: Condition) -> bool:
        """Whether a condition may be met while the event loop is blocked: only by something outside the loop."""
        match condition:
            case SetBy():
                return not self._may_guess
            case All(of=conditions):
                of = all if self._all_of is _each_of else any
                return not conditions or of(self._is_met_outside(c) for c in conditions)
            case AnyOf(of=conditions):
                return not conditions or any(self._is_met_outside(c) for c in conditions)
            case _:
                return condition is FREE


def _each_of(ways: Iterable[Lacking]) -> Lacking:
    """AND: the reasons of the first way that is barred; empty if all are open."""
    return next(filter(None, ways), ())


def _one_of(ways: Iterable[Lacking]) -> Lacking:
    """OR: the reasons of all ways together, if all are barred; empty if one is open, or there is none."""
    things: list[str] = []
    for way in ways:
        if not way:
            return ()
        things += way
    return tuple(things)


class Dead:
    """The current assumption of a reduction: the dead activities, and the groups with no slot outside their hands."""

    def __init__(self, index: Index, activities: Iterable[str]) -> None:
        self.activities = set(activities)
        held = Counter(group for i in self.activities for group in index.graph.activities[i].holds)
        self.groups = {g for g, count in held.items() if count == len(index.holders[g]) and index.is_full(g)}

    def lose(self, activity: ActivityView) -> Iterable[str]:
        """Let one activity proceed; return the reasons that this removes for others."""
        self.activities.discard(activity.id)
        freed = self.groups.intersection(activity.holds)
        self.groups -= freed
        return activity.id, *freed


def deadlocked(graph: WaitGraph, before: WaitGraph | None = None) -> set[str]:
    """Return the activities that can never take another step, whatever happens outside the snapshot.

    Args:
        before: A snapshot that was complete before this one was begun; None if this one was taken at one moment.
    """
    index = Index(graph)
    suspects = [a for a in graph.activities.values() if a.wait is not FREE or index.loop_of(a)]
    if before is not None:
        suspects = [a for a in suspects if _is_same(a, before.activities.get(a.id))]
    return reduced(index, (a.id for a in suspects))


def _is_same(now: ActivityView, then: ActivityView | None) -> bool:
    return then is not None and (now.wait, now.holds, now.serves) == (then.wait, then.holds, then.serves)


def reduced(index: Index, suspects: Iterable[str]) -> set[str]:
    """Return the suspects that cannot proceed, whatever the other activities do.

    A worklist: an activity that is found stuck waits under its reasons, and returns to the list when one of them goes.
    """
    activities, dead = index.graph.activities, Dead(index, suspects)
    watching: dict[str, set[str]] = {}
    """By reason: the activities to examine again when it goes."""
    todo = list(dead.activities)
    while todo:
        name = todo.pop()
        if name not in dead.activities:
            continue
        lacking = index.lacking(activities[name], dead)
        for thing in lacking:
            watching.setdefault(thing, set()).add(name)
        if not lacking:
            for thing in dead.lose(activities[name]):
                todo += watching.pop(thing, ())
    return dead.activities
