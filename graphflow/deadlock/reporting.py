"""The reports of deadlocks: each deadlock is explained once, by one process, and its end is reported, too.

Every process with a member in a deadlock finds the same ring, because the choice depends on nothing but ids. Of these
processes, the one with the lowest id reports it. The others log where to read the report and remember it as *foreign*,
so that one of them can report its end if the reporter exits. The process that finds it first makes the reporter search
at once.

A deadlock keeps the ring under which it was first reported: it may grow, and a later search then finds another ring
through some of the same members.
"""

from __future__ import annotations

import logging
from collections.abc import Collection, Hashable, Mapping
from functools import partial
from types import MappingProxyType
from typing import NamedTuple

from graphflow.deadlock.protocols import ProcessContext
from graphflow.errors import DeadlockError, Place
from graphflow.interface import DeadlockPolicy
from graphflow.machines.cache import GraphChange
from graphflow.machines.waits.explain import again, explanation, headline, is_in_vain, title
from graphflow.machines.waits.rings import Deadlock, is_ring
from graphflow.machines.waits.wait_graph import ActivityView, Call, Condition, WaitGraph, calls_of, goal_id
from graphflow.times import to_ns
from graphflow.wire.process import LOOK, answer_key

logger = logging.getLogger("graphflow")

PROBE_AFTER = 0.25
"""Seconds that something must have waited before it is probed."""
PULL_LIMIT = 0.5
"""Seconds that other processes have to answer."""
FORGET_AFTER = 1.5
"""Seconds for which another process's report is remembered after the waits here have ended."""
GONE_AFTER = 0.5
"""Seconds from the first sign that a process is ending until all its tokens are gone."""
HISTORY_BOUND = 256
"""Deadlocks of different members and lines that are remembered, so that each is explained in full only once."""

Ring = frozenset[str]
"""The members of a deadlock."""


class Report(NamedTuple):
    """A deadlock that this process has reported."""

    text: str
    who: str
    """Phrase for its members."""
    processes: set[str]
    """Processes of the members and of the activities that wait behind them."""
    order: tuple[str, ...]
    """The members, each of which waits for the next."""
    is_likely: bool
    """Whether it rests on the source code, which shows the wait of a loop only at some of its lines."""
    is_in_vain: bool
    """Whether a deadline will end it."""
    calls: dict[str, list[str]]
    """By member: the services and actions that it called."""

    def is_another(self, graph: WaitGraph) -> bool:
        """Whether its members are in a new deadlock, since they call something else by now."""
        now = {name: _called(graph.activities[name]) for name in self.order if name in graph.activities}
        return any(not set(names).issubset(self.calls[name]) for name, names in now.items())


class Foreign(NamedTuple):
    """A deadlock with members in this process that another process reports."""

    reporter: str
    """The process that reports it."""
    who: str
    """Phrase for its members."""
    processes: set[str]
    waits: frozenset[tuple[str, Condition]]
    """Ids and waits of the members in this process."""


class Reporter:
    """The reports of one process, those that it made and those that it left to others."""

    def __init__(self, process: ProcessContext, policy: DeadlockPolicy) -> None:
        self._process, self._policy = process, policy
        self.reports: dict[Ring, Report] = {}
        """Deadlocks that this process has reported and that still exist."""
        self.foreign: dict[Ring, Foreign] = {}
        """Deadlocks that other processes report."""
        self._left: dict[Ring, str] = {}
        """Deadlocks of this process, or in front of it, that others are to report; each with the reporter's id."""
        self._loosened: dict[Ring, int] = {}
        """By foreign deadlock: time at which its waits here were first seen to have ended, in nanoseconds."""
        self._doubted: dict[Ring, int] = {}
        """By likely deadlock: time at which it was first not found again, in nanoseconds."""
        self._is_watching = False
        self._is_closed = False
        self._history: dict[Hashable, int] = {}
        """Number of reports, by members and their lines, or by the call that was hopeless; the longest unused first."""
        self._behind: dict[Ring, set[str]] = {}
        """By deadlock of any process: titles of the victims that were reported."""

    def close(self) -> None:
        """Report no more ends."""
        self._is_closed = True

    def has_reported(self, activity: str, title: str) -> bool:
        """Whether an activity of this process was reported, as a member of a deadlock or as its victim."""
        is_in_one = any(activity in ring for ring in (*self.reports, *self.foreign))
        return is_in_one or any(title in behind for behind in list(self._behind.values()))

    @property
    def looks_again_in(self) -> float | None:
        """Seconds until another look tells whether deadlocks have ended; None if none may have."""
        return PROBE_AFTER if self._doubted else FORGET_AFTER if self.foreign else None

    def forget_victims(self) -> None:
        """Forget which victims were reported, since nothing waits any more."""
        self._behind.clear()

    def report(
        self, deadlock: Deadlock, graph: WaitGraph, elsewhere: Mapping[Ring, str] = MappingProxyType({})
    ) -> None:
        """Report a deadlock that was found, unless it was reported, or leave that to another process.

        Args:
            elsewhere: Deadlocks that other processes have reported, with the reporter.
        """
        members = [graph.activities[i] for i in deadlock.ring]
        # A wait that rests on the source code alone must have lasted: its setter may be about to run.
        if deadlock.is_likely and not all(is_old(a) for a in members):
            return
        ring, mine = frozenset(deadlock.ring), self._process.session.zid
        # A reported deadlock may have grown since, so that another of its rings is found. It keeps its first ring.
        reporters = {**elsewhere, **dict.fromkeys(self.reports, mine)}
        known = next((other for other in reporters if other & ring), ring)
        core = members if known == ring else [graph.activities[i] for i in sorted(known & set(graph.activities))]
        behind = [graph.activities[i] for i in (ring | {*deadlock.victims}) - known]
        victims = {title(a) for a in behind if a.process == mine}
        if self._policy == "break" and not deadlock.is_likely:
            self._break(deadlock, graph)
        processes = {a.process for a in core}
        # A process whose loop is blocked cannot see the others, so it reports only if all of them are blocked.
        reporter = reporters.get(known) or min(processes - set(graph.blocked) or processes)
        if reporter != mine:
            self._left[known] = reporter
            if known not in {*self._behind, *elsewhere}:
                key = answer_key(self._process.domain, LOOK, reporter)
                self._process.session.ask_reports(key, PULL_LIMIT, _ignore)
            self._note_foreign(known, core, reporter)
        is_first = known not in self._behind and self.count(lines_of(core)) == 1
        if reporter == mine and known not in self.reports:
            self._log(deadlock, graph, _titles(core), processes | {a.process for a in behind}, is_first=is_first)
            self._behind[ring] = victims
        if known not in self._behind and not is_first:
            self._behind[known] = victims
        report = self.reports.get(known)
        who = _titles(core) if report is None else report.who
        for victim in sorted(victims - self._behind.setdefault(known, set())):
            logger.warning("%s waits behind the deadlock of %s", victim, who)
        self._behind[known] |= victims

    def left_to_silent(self, answered: Collection[str]) -> dict[Ring, str]:
        """Return the deadlocks that were left to processes that exist and have not answered now, with the process.

        Without those processes' waits, another ring through the same members looks like a deadlock of its own.
        """
        silent = {entity.zid for entity in self._process.cache}.difference(answered)
        self._left = {ring: reporter for ring, reporter in self._left.items() if reporter in silent}
        return self._left.copy()

    def _note_foreign(self, ring: Ring, core: list[ActivityView], reporter: str) -> None:
        """Log, once, where to read the report of a deadlock that another process reports."""
        mine = self._process.session.zid
        own = [a for a in core if a.process == mine]
        if not own or ring in self.foreign:
            return
        waits = frozenset((a.id, a.wait) for a in own)
        self.foreign[ring] = Foreign(reporter, _titles(core), {a.process for a in core}, waits)
        who = " and ".join(f"{title(a)} ({a.line} in {a.function})" for a in own)
        there = next((a.node for a in core if a.process == reporter), "another process")
        logger.warning("%s waits in a deadlock: the log of %s explains it, and says when it is over", who, there)
        if not self._is_watching:
            self._is_watching = True
            self._process.on_change(self._changed)

    def _log(self, deadlock: Deadlock, graph: WaitGraph, who: str, processes: set[str], *, is_first: bool) -> None:
        """Log a report: in full the first time, then in one line."""
        members = [graph.activities[i] for i in deadlock.ring]
        in_vain, text = is_in_vain(deadlock, graph), explanation(deadlock, graph)
        calls = {activity.id: _called(activity) for activity in members}
        ring = frozenset(deadlock.ring)
        self.reports[ring] = Report(text, who, processes, deadlock.ring, deadlock.is_likely, in_vain, calls)
        if is_first:
            logger.log(logging.WARNING if in_vain else logging.ERROR, "%s", text)
        elif not in_vain:
            logger.error("%s", again(headline(deadlock, graph), self._history.get(lines_of(members), 2)))

    def count(self, key: Hashable) -> int:
        """Count a report; return how often it has been made, this time included."""
        times = self._history.pop(key, 0) + 1
        self._history[key] = times  # at the end, so that the first entry is the one that is longest unused
        if len(self._history) > HISTORY_BOUND:
            del self._history[next(iter(self._history))]
        return times

    def is_known(self, ring: Ring) -> bool:
        """Whether a deadlock, or another ring through one of its members, is reported and still exists."""
        return any(ring & known for known in self.reports)

    def _break(self, deadlock: Deadlock, graph: WaitGraph) -> None:
        """Fail the youngest call or goal of the ring, if it is this process's.

        All processes with a member find the same ring and must choose the same victim without talking to each other:
        hence the rounded age, and the id where that is equal.
        """
        ledger = self._process.ledger
        ways = zip(deadlock.ring, deadlock.edges, strict=True)
        calls = [(graph.activities[name], edge.via) for name, edge in ways if isinstance(edge.via, Call)]
        if not calls:
            return
        activity, call = min(calls, key=lambda pair: (round(pair[0].age, 1), pair[0].id))
        if activity.process != self._process.session.zid:
            return
        futures = [future for future, entry in ledger.calls.items() if entry.id == call.id]
        futures += [f for f, goal in ledger.goals.items() if goal_id(goal.goal_id) == call.id and f is not goal.ended]
        for future in futures:
            if not future.done():
                future.set_exception(DeadlockError(explanation(deadlock, graph)))

    def take_back(self, graph: WaitGraph, dead: set[str], processes: set[str]) -> None:
        """Take back reports of rings that no longer exist.

        Args:
            processes: The processes that `graph` includes. Nothing is known about others.
        """
        for ring, report in list(self.reports.items()):
            unknown = report.processes - processes
            stands = is_ring(report.order, graph, dead) and not report.is_another(graph)
            if stands:
                self._doubted.pop(ring, None)
            if stands or any(entity.zid in unknown for entity in self._process.cache):
                continue
            if report.is_likely and ring <= graph.activities.keys() and not self._stays_away(ring):
                continue
            self._doubted.pop(ring, None)
            del self.reports[ring]
            self._behind.pop(ring, None)
            if not ring <= dead and not report.is_in_vain:  # members that are dead are in another ring, reported next
                logger.warning("the deadlock of %s has cleared", report.who)

    def _stays_away(self, ring: Ring) -> bool:
        """Note that a deadlock is out of sight; return whether it has been for a while, not at one line of a loop."""
        now_ns = self._process.clock.monotonic_ns()
        return now_ns - self._doubted.setdefault(ring, now_ns) >= to_ns(0.999 * PROBE_AFTER)

    def forget_foreign(self, graph: WaitGraph) -> None:
        """Forget deadlocks that others report, and whose waits here ended a while ago: they have cleared.

        Not at once: the reporter may be exiting, and then its calls end before its tokens do.
        """
        now_ns, known = self._process.clock.monotonic_ns(), graph.activities
        for ring, foreign in list(self.foreign.items()):
            if all(name in known and known[name].wait == wait for name, wait in foreign.waits):
                self._loosened.pop(ring, None)
            elif now_ns - self._loosened.setdefault(ring, now_ns) >= to_ns(0.999 * FORGET_AFTER):
                del self.foreign[ring], self._loosened[ring]

    def _changed(self, change: GraphChange) -> None:
        """Prepare to report the end of a deadlock whose reporter may be exiting."""
        if change.alive:
            return
        leaving = {ring for ring, foreign in self.foreign.items() if foreign.reporter == change.entity.zid}
        for ring in leaving:
            foreign, clock = self.foreign.pop(ring), self._process.clock
            self._loosened.pop(ring, None)
            clock.call_at(clock.monotonic_ns() + to_ns(GONE_AFTER), partial(self._report_gone, ring, foreign))

    def _report_gone(self, ring: Ring, foreign: Foreign) -> None:
        alive = {entity.zid for entity in self._process.cache}
        if foreign.reporter in alive:
            self.foreign[ring] = foreign  # the process has closed an endpoint, and goes on
        elif not self._is_closed and self._process.session.zid == min(foreign.processes & alive, default=""):
            logger.warning("the deadlock of %s has cleared: one of its processes has gone", foreign.who)


def lines_of(members: list[ActivityView]) -> frozenset[tuple[str, Place]]:
    """Return the key by which a deadlock is recognized when it recurs: its members, and the lines where they wait."""
    return frozenset((title(activity), activity.place) for activity in members)


def _titles(members: list[ActivityView]) -> str:
    return " and ".join(map(title, members))


def _called(activity: ActivityView) -> list[str]:
    return [call.name for call in calls_of(activity.wait)]


def _ignore(*_: object) -> None:
    """Ignore the answers."""


def is_old(activity: ActivityView) -> bool:
    """Whether an activity has waited long enough to be probed."""
    # A little less, since the loop may run the alarm for it a little early.
    return activity.age >= 0.999 * PROBE_AFTER
