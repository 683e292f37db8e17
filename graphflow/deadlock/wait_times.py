"""The ages of waits, and the time until their deadlines, by the ledger and from one snapshot to the next."""

from __future__ import annotations

from graphflow.deadlock import asyncio_frames as aio
from graphflow.deadlock.asyncio_frames import TaskLike, waiter_of
from graphflow.deadlock.protocols import ProcessContext
from graphflow.executor.activity import Activity
from graphflow.executor.clock import WallClock
from graphflow.machines.waits.wait_graph import FREE, Condition, Opening, SetBy, calls_of, goal_id, parts_of


class WaitTimes:
    """The times of the waits of a process."""

    def __init__(self, process: ProcessContext) -> None:
        self._process = process
        self._since: dict[tuple[str, Condition], int] = {}
        """By activity and wait: time at which it was first seen, in nanoseconds."""

    def of(
        self, activity: str, wait: Condition, task: TaskLike, now_ns: int, limit_ns: int | None
    ) -> tuple[float, float | None]:
        """Return the seconds that an activity has waited, and those until its deadline, or None for no deadline.

        Args:
            activity: Its id.
            now_ns, limit_ns: The time, and that at which a timeout around the wait ends it, by the process's clock.
        """
        began, deadline = self._bounds(wait)
        if wait is not FREE and limit_ns is not None:
            deadline = min(limit_ns, deadline or limit_ns)
        if began is None:
            age = 0.0 if wait is FREE else self._age(activity, wait, now_ns)
            if isinstance(wait, SetBy) and isinstance(task, Activity) and self._is_steady(task):
                age = max(age, self._process.loop.time() - task.suspended_at)
        else:
            age = (now_ns - began) / 1e9
        return age, None if deadline is None else (deadline - now_ns) / 1e9

    def forget(self, keep: set[tuple[str, Condition]]) -> None:
        """Forget the ages of all waits but these."""
        self._since = {key: when for key, when in self._since.items() if key in keep}

    def _is_steady(self, activity: Activity) -> bool:
        """Whether an activity has had the same wait since it was suspended, and by the loop's clock."""
        return isinstance(self._process.clock, WallClock) and not aio.stands_for_others(waiter_of(activity))

    def _bounds(self, wait: Condition) -> tuple[int | None, int | None]:
        """Return the time at which the first of the awaited calls began, and that of their first deadline."""
        ledger = self._process.ledger
        wanted = {call.id for call in calls_of(wait)}
        services = {part.service for part in parts_of(wait) if isinstance(part, Opening)}
        found = [c for c in list(ledger.calls.values()) if c.id in wanted]
        deadlines = [c.deadline_ns for c in found if c.deadline_ns is not None]
        began = [c.began_ns for c in found]
        began += [o.began_ns for o in list(ledger.openings.values()) if o.service in services]
        began += [g.began_ns for g in list(ledger.goals.values()) if goal_id(g.goal_id) in wanted]
        return min(began, default=None), min(deadlines, default=None)

    def _age(self, activity: str, wait: Condition, now_ns: int) -> float:
        """Return the seconds since a wait was first seen."""
        return (now_ns - self._since.setdefault((activity, wait), now_ns)) / 1e9
