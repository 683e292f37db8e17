"""Which activities of a snapshot can never proceed.

`deadlocked` is Holt's reduction: every activity that may proceed does so and gives everything back, until none is left
that can. It is optimistic: what the snapshot does not show may proceed. So what remains cannot, whatever happens
outside.

Snapshots of several processes are not taken at one moment. An activity counts as stuck only if it was seen in the very
same wait in a snapshot that was complete before the present one was begun: ids are never reused, so at some moment
between the two all the remaining waits existed together.

Source: Holt, "Some deadlock properties of computer systems", 1972.
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
"""Activities that must proceed, or groups that must get a free slot, before something can happen: at least one of them.
Empty: it may happen now."""


class Index:
    """A snapshot indexed for lookup.

    Args:
        may_fail: Whether an error in one of several things waited for may end the wait for all of them.
        may_guess: Whether to assume that only what the source code shows brings about what is waited for.
    """

    def __init__(self, graph: WaitGraph, *, may_fail: bool = False, may_guess: bool = True) -> None:
        self.graph = graph
        self.holders: dict[str, list[str]] = {}
        """Activities by the group whose slot they hold."""
        self.serving: dict[str, list[str]] = {}
        """Activities by the call that they answer."""
        for activity in graph.activities.values():
            for group in activity.holds:
                self.holders.setdefault(group, []).append(activity.id)
            if activity.serves:
                self.serving.setdefault(activity.serves, []).append(activity.id)
        self.queued: dict[str, list[QueueView]] = {}
        """Queues by the calls that wait in them."""
        for queue in graph.queues.values():
            for call in queue.calls:
                self.queued.setdefault(call, []).append(queue)
        self.opening: dict[str, list[QueueView]] = {}
        """Queues of handlers that may not run yet, by the service that there will be when they may."""
        for queue in graph.queues.values():
            for service in queue.opens:
                self.opening.setdefault(service, []).append(queue)
        self._all_of = _one_of if may_fail else _each_of
        self._may_guess = may_guess

    def is_full(self, group: str) -> bool:
        """Whether all slots of a group are held."""
        known = self.graph.groups.get(group)
        return known is not None and known.limit is not None and len(self.holders.get(group, ())) >= known.limit

    def loop_of(self, activity: ActivityView) -> str | None:
        """The activity that blocks this one's event loop, if another does."""
        blocker = self.graph.blocked.get(activity.process)
        return None if blocker == activity.id else blocker

    def lacking(self, activity: ActivityView, dead: Dead) -> Lacking:
        """What keeps an activity from proceeding."""
        blocker = self.graph.blocked.get(activity.process)
        if blocker == activity.id:
            return () if self._is_met_outside(activity.wait) else (activity.id,)
        return self._of(blocker, dead) or self.lacking_for(activity.wait, dead)

    def lacking_for(self, condition: Condition, dead: Dead) -> Lacking:
        """What keeps a condition from being fulfilled."""
        match condition:
            case Call(id=call, servers=servers):
                serving, queued = self.ways_of(call)
                if len(serving) + len(queued) < servers and not any(queue.has_answers for queue in queued):
                    return ()  # a server that the snapshot does not show may answer
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
        """The activities of which one must end, and the queues of which one must be handled, for a call to return."""
        queued = self.queued.get(call, [])
        answers = [queue for queue in queued if queue.has_answers]
        return ([], answers) if answers else (self.serving.get(call, []), queued)

    def lacking_to_run(self, queue: QueueView, dead: Dead) -> Lacking:
        """What keeps the next run of a handler from beginning."""
        blocker = self._of(self.graph.blocked.get(queue.process), dead)
        return blocker or next(((group,) for group in queue.needs if group in dead.groups), ())

    def _of(self, activity: str | None, dead: Dead) -> Lacking:
        return (activity,) if activity is not None and activity in dead.activities else ()

    def _is_met_outside(self, condition: Condition) -> bool:
        """Whether a condition may be met while the event loop, which carries all that is graphflow's, is blocked."""
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
    return next(filter(None, ways), ())


def _one_of(ways: Iterable[Lacking]) -> Lacking:
    """The reasons why all of several ways are barred; empty if there are none, or one is open."""
    things: list[str] = []
    for way in ways:
        if not way:
            return ()
        things += way
    return tuple(things)


class Dead:
    """Activities taken to be stuck, and the groups whose slots they therefore all hold."""

    def __init__(self, index: Index, activities: Iterable[str]) -> None:
        self.activities = set(activities)
        held = Counter(group for i in self.activities for group in index.graph.activities[i].holds)
        self.groups = {g for g, count in held.items() if count == len(index.holders[g]) and index.is_full(g)}

    def lose(self, activity: ActivityView) -> Iterable[str]:
        """Let one of them proceed; returns what that changes for others."""
        self.activities.discard(activity.id)
        freed = self.groups.intersection(activity.holds)
        self.groups -= freed
        return activity.id, *freed


def deadlocked(graph: WaitGraph, before: WaitGraph | None = None) -> set[str]:
    """The activities that can never take another step, whatever happens outside the snapshot.

    Args:
        before: A snapshot that was complete before this one was begun; None when this one was taken at one moment.
    """
    index = Index(graph)
    suspects = [a for a in graph.activities.values() if a.wait is not FREE or index.loop_of(a)]
    if before is not None:
        suspects = [a for a in suspects if _is_same(a, before.activities.get(a.id))]
    return reduced(index, (a.id for a in suspects))


def _is_same(now: ActivityView, then: ActivityView | None) -> bool:
    return then is not None and (now.wait, now.holds, now.serves) == (then.wait, then.holds, then.serves)


def reduced(index: Index, suspects: Iterable[str]) -> set[str]:
    """The suspects that cannot proceed, whatever the others do."""
    activities, dead = index.graph.activities, Dead(index, suspects)
    watching: dict[str, set[str]] = {}
    """By what they lack: the activities to look at again when it changes."""
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
