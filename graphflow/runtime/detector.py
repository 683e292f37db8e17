"""Looks for deadlocks when somebody has waited: first in this process, then, if waits lead out of it, in all.

Nothing is done while nothing waits. A call, or work that finds no slot, arms a look a quarter of a second later; what
still waits then is looked at, and again at growing distances. Deadlocks within a process are seen in one picture of
it. For others all processes are asked twice, as `machines.waits` explains. Every process that has a part in a
deadlock finds it; the one that comes first by id reports it, and says when it is over.
"""

from __future__ import annotations

import json
import logging
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from graphflow.errors import DeadlockError
from graphflow.interface import DeadlockPolicy
from graphflow.machines.explain import explanation, hopeless, title
from graphflow.machines.picture import from_json
from graphflow.machines.waits import FREE, Activity, Call, Condition, Deadlock, Picture, deadlocked, explained, joined
from graphflow.runtime.inspection import WAITS, key
from graphflow.runtime.scheduler import Run, Runner
from graphflow.runtime.waits import goal_id
from graphflow.times import to_ns

if TYPE_CHECKING:
    from graphflow.runtime.clock import Handle
    from graphflow.runtime.context import Context

logger = logging.getLogger("graphflow")

PROBE_AFTER = 0.25
"""Seconds that something waits before it is looked at."""
PROBE_LONGEST = 8.0
"""Seconds between two looks at the same waits, at most."""
PULL_LIMIT = 0.5
"""Seconds that other processes get to answer."""

Key = frozenset[tuple[str, Condition]]


class Detector:
    """The search for deadlocks in which one process has a part. One per `Context`."""

    def __init__(self, context: Context, policy: DeadlockPolicy) -> None:
        self._context = context
        self.policy = policy
        self.is_on = policy != "off"
        """Whether anybody wants to know; when not, calls keep no account of what they wait for."""
        self.is_armed = policy == "off"
        """Whether a look is due soon; always, and in vain, when nobody wants to know."""
        self.pulls = 0
        """How often other processes were asked."""
        self.reports: dict[Key, tuple[str, str]] = {}
        """The deadlocks there are now: explained, and who has a part in them."""
        self._period = PROBE_AFTER
        self._handle: Handle | None = None
        self._last: set[tuple[str, Condition]] = set()
        self._lock = threading.Lock()

    def arm(self) -> None:
        """Something waits. Called for every call and every stall: next to nothing when a look is due already."""
        if not self.is_armed:
            self._period = PROBE_AFTER
            self._schedule(PROBE_AFTER)

    def _schedule(self, seconds: float) -> None:
        if self._handle is not None:
            self._handle.cancel()
        self.is_armed = seconds <= PROBE_AFTER
        clock = self._context.clock
        self._handle = clock.call_at(clock.monotonic_ns() + to_ns(seconds), self._probe)

    def _probe(self) -> None:
        """Look at what waits, and decide when to look again."""
        try:
            self._look()
        except Exception as error:  # a search that has stumbled must not be the last
            logger.debug("the search for deadlocks: %r", error, exc_info=error)
            self._schedule(PROBE_LONGEST)

    def _look(self) -> None:
        picture = self._context.waits.picture()
        mine = self._context.session.zid
        self._say_cleared(picture, {mine})
        if any(not _is_of(mine, pair[0]) for ring in self.reports for pair in ring):
            self._ask(self._look_again)
        waiting = {(a.id, a.wait) for a in picture.activities.values() if a.wait is not FREE}
        if not waiting and not any(q.waiting for q in picture.queues.values()):
            self.is_armed = not self.is_on
            self._last.clear()
            return
        young = [a.age for a in picture.activities.values() if a.wait is not FREE and not _is_old(a)]
        for deadlock in explained(picture, deadlocked(picture)):
            self._tell(deadlock, picture)
        if any(self._leaves(a, picture) for a in picture.activities.values() if _is_old(a)):
            self._pull()
        is_new = bool(waiting - self._last)
        self._last = waiting
        longest = 2 * PROBE_AFTER if self.reports else PROBE_LONGEST
        self._period = PROBE_AFTER if is_new else min(2 * self._period, longest)
        soonest = PROBE_AFTER - max(young) if young else self._period
        self._schedule(min(max(soonest, 0.01), self._period))

    def _leaves(self, activity: Activity, picture: Picture) -> bool:
        """Whether an activity waits for another process."""
        here = {a.serves for a in picture.activities.values()} | {c for q in picture.queues.values() for c in q.calls}
        return any(call not in here for call in _calls(activity.wait))

    # other processes

    def _pull(self) -> None:
        def first(replies: list[bytes]) -> None:
            before = self._whole(replies)
            if any(self._context.session.zid == before.activities[i].process for i in deadlocked(before)):
                self._ask(lambda again: self._conclude(before, self._whole(again)))

        self._ask(first)

    def _ask(self, told: Callable[[list[bytes]], None]) -> None:
        self.pulls += 1
        self._context.session.ask_reports(key(self._context.domain, WAITS), PULL_LIMIT, told)

    def _whole(self, replies: list[bytes]) -> Picture:
        pictures = []
        for reply in replies:
            try:
                pictures.append(from_json(json.loads(reply)))
            except (ValueError, KeyError, TypeError, RecursionError) as error:
                logger.debug("a picture of waits that cannot be read: %s", error)
        return joined([*pictures, self._context.waits.picture()])

    def _look_again(self, replies: list[bytes]) -> None:
        """Whether what was reported still stands in other processes."""
        whole = self._whole(replies)
        self._say_cleared(whole, {queue.process for queue in whole.queues.values()})

    def _conclude(self, before: Picture, now: Picture) -> None:
        dead = deadlocked(now, before)
        for deadlock in explained(now, dead):
            self._tell(deadlock, now)

    # what is said

    @property
    def fails_hopeless(self) -> bool:
        """Whether a call that cannot succeed is ended at once."""
        return self.policy in ("raise", "break")

    def why_hopeless(self, service: str, runner: Runner, holders: list[Run]) -> str:
        """Why a call can never be answered: its server's group is full of runs that wait for it."""
        picture = self._context.waits.picture()
        zid = self._context.session.zid
        found = [
            picture.activities[f"{zid}:{run.number}"] for run in holders if f"{zid}:{run.number}" in picture.activities
        ]
        return hopeless(service, picture.queues[f"{zid}:q{runner.number}"], found, picture)

    def _tell(self, deadlock: Deadlock, picture: Picture) -> None:
        members = [picture.activities[i] for i in deadlock.ring]
        # What only the source code tells must have lasted: a setter may be about to run.
        if deadlock.is_likely and not all(_is_old(a) for a in members):
            return
        ring = frozenset((name, edge.via) for name, edge in zip(deadlock.ring, deadlock.edges, strict=True))
        mine = self._context.session.zid
        if self.policy == "break" and not deadlock.is_likely:
            self._break(deadlock, picture)
        able = sorted({a.process for a in members if a.process not in picture.blocked}) or [mine]
        if ring in self.reports or able[0] != mine:
            return
        text = explanation(deadlock, picture)
        self.reports[ring] = text, " and ".join(title(a) for a in members)
        logger.error("%s", text)

    def _break(self, deadlock: Deadlock, picture: Picture) -> None:
        """End the youngest call or goal of the ring, if it is of this process: all find the ring, and agree on one."""
        waits = self._context.waits
        ways = zip(deadlock.ring, deadlock.edges, strict=True)
        calls = [(picture.activities[name], edge.via) for name, edge in ways if isinstance(edge.via, Call)]
        if not calls:
            return
        activity, call = min(calls, key=lambda pair: (round(pair[0].age, 1), pair[0].id))
        if activity.process != self._context.session.zid:
            return
        futures = [future for future, entry in waits.calls.items() if waits.id_of(entry) == call.id]
        futures += [f for f, goal in waits.goals.items() if goal_id(goal.goal_id) == call.id and f is not goal.ended]
        for future in futures:
            if not future.done():
                future.set_exception(DeadlockError(explanation(deadlock, picture)))

    def _say_cleared(self, picture: Picture, processes: set[str]) -> None:
        """Take back reports of rings of which a member in one of these processes has moved on."""

        def still_waits(name: str, via: Condition) -> bool:
            activity = picture.activities.get(name)
            return activity is not None and _contains(activity.wait, via)

        for ring in list(self.reports):
            known = [pair for pair in ring if pair[0].partition(":")[0] in processes]
            if not all(still_waits(name, via) for name, via in known):
                _, who = self.reports.pop(ring)
                logger.warning("the deadlock of %s has cleared", who)

    def probe_blocked(self) -> None:
        """The event loop is blocked: look from the thread that has noticed it."""
        if self.policy == "off" or not self._lock.acquire(blocking=False):
            return
        try:
            picture = self._context.waits.picture()
            for deadlock in explained(picture, deadlocked(picture)):
                self._tell(deadlock, picture)
                self._context.loop.call_soon_threadsafe(self.arm)  # to see it cleared
        finally:
            self._lock.release()

    def close(self) -> None:
        """Look no more."""
        if self._handle is not None:
            self._handle.cancel()
        self.is_armed = True


def _is_of(process: str, activity: str) -> bool:
    return activity.startswith(f"{process}:")


def _contains(wait: Condition, part: Condition) -> bool:
    return wait == part or any(_contains(inner, part) for inner in getattr(wait, "of", ()))


def _is_old(activity: Activity) -> bool:
    """Whether it has waited long enough to be looked at."""
    return activity.age >= 0.999 * PROBE_AFTER


def _calls(wait: Condition) -> list[str]:
    if isinstance(wait, Call):
        return [wait.id]
    return [call for inner in getattr(wait, "of", ()) for call in _calls(inner)]
