"""Looks for deadlocks when something has waited: first in this process, then, if waits lead out of it, in all.

Nothing is done while nothing waits. A call, or work that finds no slot, arms a look a quarter of a second later, and
so does the start of a task; what still waits then is looked at, and again at growing intervals. Deadlocks within a
process show in one snapshot of it. For others all processes are asked twice, as `machines.reduction` explains.
Every process that has a part in a deadlock finds it; the one with the lowest id reports it, and says when it is
over, and the others say where to read that. The process that finds it first makes that one look at once.
"""

from __future__ import annotations

import json
import logging
import threading
from collections.abc import Callable, Hashable, Mapping
from contextlib import suppress
from functools import partial
from types import MappingProxyType
from typing import NamedTuple

from graphflow.deadlock.chains import Chains
from graphflow.deadlock.protocols import ProcessContext
from graphflow.deadlock.snapshot import Snapshot
from graphflow.deadlock.stalls import Stalls
from graphflow.deadlock.unresponsive import SILENT_AFTER, Unresponsive
from graphflow.deadlock.watchdog import Watchdog
from graphflow.errors import DeadlockError, Place
from graphflow.executor.clock import Alarm
from graphflow.executor.ledger import PendingCall
from graphflow.executor.runner import Runner
from graphflow.interface import DeadlockPolicy
from graphflow.machines.cache import GraphChange
from graphflow.machines.waits.explain import again, explanation, headline, hopeless, is_in_vain, title
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import Deadlock, explained, is_ring
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    Call,
    Condition,
    Opening,
    WaitGraph,
    calls_of,
    goal_id,
    joined,
    parts_of,
)
from graphflow.machines.waits.wait_graph_json import from_json
from graphflow.times import to_ns
from graphflow.wire.process import LOOK, WAITS, answer_key

logger = logging.getLogger("graphflow")

PROBE_AFTER = 0.25
"""Seconds that something waits before it is looked at."""
PROBE_LONGEST = 8.0
"""Longest interval in seconds between two looks at the same waits."""
TASKS_EVERY = 2.0
"""Seconds between two looks at tasks, whose waits are not announced, while nothing else waits."""
PULL_LIMIT = 0.5
"""Seconds that other processes have to answer."""
FORGET_AFTER = 1.5
"""Seconds that a deadlock which another process reports is remembered when its waits here are over."""
GONE_AFTER = 0.5
"""Seconds from the first sign that a process is going until all of it has gone."""

TOLD_BOUND = 256
"""Deadlocks of different members and lines that are remembered, to tell each whole only once."""

Ring = frozenset[str]
"""The members of a deadlock."""


class Report(NamedTuple):
    """A deadlock that was reported."""

    text: str
    who: str
    """A member, in words."""
    processes: set[str]
    """The processes of its members, and of what waits behind them."""
    order: tuple[str, ...]
    """The members, each of which waits for the next."""
    is_in_vain: bool
    """Whether a deadline will end it."""
    calls: dict[str, list[str]]
    """What each member calls, by name."""

    def is_another(self, graph: WaitGraph) -> bool:
        """Whether its members call something else by now."""
        now = {name: _called(graph.activities[name]) for name in self.order if name in graph.activities}
        return any(not set(names).issubset(self.calls[name]) for name, names in now.items())


class Picture(NamedTuple):
    """What processes have answered, and this one's waits."""

    graph: WaitGraph
    answered: set[str]
    """The processes whose waits it shows."""
    told: dict[Ring, str]
    """The deadlocks that others have reported and that still exist, with the process that has."""


class Foreign(NamedTuple):
    """A deadlock with a part in this process that another process must report."""

    reporter: str
    """The process that must report it."""
    who: str
    processes: set[str]
    waits: frozenset[tuple[str, Condition]]
    """The members that are in this process."""


class Search:
    """The search for deadlocks in which one process has a part. One per process."""

    def __init__(self, process: ProcessContext, policy: DeadlockPolicy) -> None:
        self._process = process
        self.policy = policy
        self.is_on = policy != "off"
        """Whether deadlocks are looked for."""
        self.is_armed = policy == "off"
        """Whether a look is due soon; always true, to no effect, when deadlocks are not looked for."""
        self.pulls = 0
        """How often other processes were asked."""
        self.reports: dict[Ring, Report] = {}
        """The deadlocks that this process has reported and that still exist."""
        self.stalls = Stalls()
        self.watchdog = Watchdog(process.loop, self._probe_blocked)
        self.snapshot = Snapshot(process, self.watchdog)
        self._chains = Chains(process.ledger, process.session.zid)
        self._unresponsive = Unresponsive(process)
        self._dead: set[str] = set()
        """Activities last found to be dead with the help of other processes."""
        self._foreign: dict[Ring, Foreign] = {}
        """If the process that must report them goes, another one has to say that they are over."""
        self._loosened: dict[Ring, int] = {}
        """Of those: when its waits here were first seen to be over, in nanoseconds."""
        self._is_watching = False
        self._told: dict[Hashable, int] = {}
        """How often a deadlock has been told, by its members and their lines, or by the call that is hopeless."""
        self._behind: dict[Ring, set[str]] = {}
        """What was reported to wait for a deadlock, by deadlock of any process."""
        self._period = PROBE_AFTER
        self._grown_ns = 0
        """When the period was last made longer."""
        self._alarm: Alarm | None = None
        self._last: set[tuple[str, Condition]] = set()
        self._lock = threading.Lock()
        self._is_closed = False
        process.ledger.alert = self.arm

    # what the runtime asks

    def arm(self) -> None:
        """Something waits. Called for every call and every stall: costs next to nothing when a look is already due."""
        if not self.is_armed:
            self._period = PROBE_AFTER
            self._schedule(PROBE_AFTER)

    def chain(self, call: PendingCall) -> bytes:
        """What a call that begins to wait carries, for `hopeless` at its server."""
        return self._chains.of(call) if self.is_on else b""

    def hopeless(self, service: str, runner: Runner, asked: bytes) -> str:
        """Why a queued request can never be answered, where it must fail for that; empty if it may be answered.

        It cannot when its server's group is full of runs that wait for it.

        Args:
            runner: The server's runner.
            asked: The attachment of the request.
        """
        if self.policy not in ("raise", "break"):
            return ""
        holders = self._chains.holders(runner, asked)
        if not holders:
            return ""
        graph, zid = self.snapshot.take(), self._process.session.zid
        ids = [f"{zid}:{run.number}" for run in holders]
        found = [graph.activities[name] for name in ids if name in graph.activities]
        own, others = self._chains.between(holders, asked)
        way = [graph.activities[name] for name in (f"{zid}:{number}" for number in own) if name in graph.activities]
        text = hopeless(service, graph.queues[f"{zid}:q{runner.number}"], found, graph, way, others)
        times = self._count((service, *_lines(found)))
        return text if times == 1 else again(text.partition("\n")[0], times)

    def tells_of(self, activity: str, title: str) -> bool:
        """Whether an activity of this process is in a deadlock that was reported, or was said to wait behind one."""
        is_in_one = any(activity in ring for ring in (*self.reports, *self._foreign))
        return is_in_one or any(title in behind for behind in list(self._behind.values()))

    def close(self) -> None:
        """Stop looking."""
        self._is_closed = True
        self.watchdog.close()
        if self._alarm is not None:
            self._alarm.cancel()
        self.is_armed = True

    # when it looks

    def _schedule(self, seconds: float) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
        self.is_armed = seconds <= PROBE_AFTER
        clock = self._process.clock
        self._alarm = clock.call_at(clock.monotonic_ns() + to_ns(seconds), self._probe)

    def _probe(self) -> None:
        """Look at what waits, and decide when to look again."""
        try:
            self._look()
        except Exception as error:  # a failed search must not be the last
            logger.debug("the search for deadlocks: %r", error, exc_info=error)
            self._schedule(PROBE_LONGEST)

    def _look(self) -> None:
        graph = self.snapshot.take()
        mine = self._process.session.zid
        dead = deadlocked(graph)
        self._take_back(graph, dead, {mine})
        if any(report.processes != {mine} for report in self.reports.values()):
            self._ask(self._look_again)
        self._forget_foreign(graph)
        waiting = {(a.id, a.wait) for a in graph.activities.values() if a.wait is not FREE}
        if not waiting and not any(q.waiting for q in graph.queues.values()):
            self.is_armed = not self.is_on
            self._last.clear()
            self._behind.clear()
            self._stall(graph, set())
            if self._foreign or any(node.tasks for node in self._process.nodes):
                self._schedule(FORGET_AFTER if self._foreign else TASKS_EVERY)
            return
        young = [a.age for a in graph.activities.values() if a.wait is not FREE and not _is_old(a)]
        found = explained(graph, dead)
        is_told_whole = _is_asked(graph) and not all(self._is_reported(frozenset(d.ring)) for d in found)
        for deadlock in () if is_told_whole else found:
            self._tell(deadlock, graph)
        if is_told_whole or any(self._leaves(a, graph) for a in graph.activities.values() if _is_old(a)):
            self._pull()
        is_new = bool(waiting - self._last)
        self._last = waiting
        longest = 2 * PROBE_AFTER if self.reports else PROBE_LONGEST
        now_ns = self._process.clock.monotonic_ns()
        if is_new:
            self._period, self._grown_ns = PROBE_AFTER, now_ns
        elif now_ns - self._grown_ns >= to_ns(0.999 * self._period):
            self._period, self._grown_ns = min(2 * self._period, longest), now_ns
        else:
            self._period = min(self._period, longest)
        soonest = [PROBE_AFTER - max(young)] if young else []
        soonest += [SILENT_AFTER] if self._unresponsive else []
        soonest += self._stall(graph, dead | self._dead)
        self._schedule(min(max(min(soonest, default=self._period), 0.01), self._period))

    def _stall(self, graph: WaitGraph, dead: set[str]) -> list[float]:
        due = self.stalls.look(graph, dead, self._process.clock.monotonic_ns())
        return [] if due is None else [due]

    def _leaves(self, activity: ActivityView, graph: WaitGraph) -> bool:
        """Whether an activity waits for another process."""
        here = {a.serves for a in graph.activities.values()} | {c for q in graph.queues.values() for c in q.calls}
        opening = {service for queue in graph.queues.values() for service in queue.opens}
        wanted = [part.service for part in parts_of(activity.wait) if isinstance(part, Opening)]
        calls = calls_of(activity.wait)
        return any(c.id not in here or c.servers > 1 for c in calls) or not opening.issuperset(wanted)

    # other processes

    def _pull(self) -> None:
        """Ask all twice. Those that do not answer count as alive, so what the others say may be enough."""
        goes_on = False

        def first(replies: list[bytes], is_all: bool) -> None:
            nonlocal goes_on
            before = self._whole(replies)
            if is_all:
                self._unresponsive.compare(self.snapshot.take(), before.answered)
            dead = () if goes_on else deadlocked(before.graph)
            if any(self._process.session.zid == before.graph.activities[i].process for i in dead):
                goes_on = True
                self._ask(lambda again, _: self._conclude(before.graph, self._whole(again)))

        self._ask(first)

    def _ask(self, told: Callable[[list[bytes], bool], None]) -> None:
        if self._is_closed:
            return
        self.pulls += 1
        self._process.session.ask_reports(answer_key(self._process.domain, WAITS), PULL_LIMIT, told)

    def _whole(self, replies: list[bytes]) -> Picture:
        """The waits of all."""
        graphs, answered, told = [], {self._process.session.zid}, dict[Ring, str]()
        for reply in replies:
            try:
                data = json.loads(reply)
                graph, process = from_json(data), str(data["process"])
                rings = [frozenset(map(str, ring)) for ring in data["rings"]]
            except (ValueError, KeyError, TypeError, RecursionError) as error:
                logger.debug("a snapshot of waits that cannot be read: %s", error)
                continue
            graphs.append(graph)
            answered.add(process)
            told |= dict.fromkeys(rings, process)
        return Picture(joined([*graphs, self.snapshot.take()]), answered, told)

    def _look_again(self, replies: list[bytes], is_all: bool) -> None:
        """Whether what was reported still stands in other processes."""
        if not is_all:
            return
        whole = self._whole(replies)
        self._take_back(whole.graph, deadlocked(whole.graph), whole.answered)

    def _conclude(self, before: WaitGraph, now: Picture) -> None:
        self._dead = deadlocked(now.graph, before)
        for deadlock in explained(now.graph, self._dead):
            self._tell(deadlock, now.graph, now.told)
        if self.reports:  # to see when they are over
            self._schedule(min(self._period, 2 * PROBE_AFTER))

    # what is said

    def _tell(self, deadlock: Deadlock, graph: WaitGraph, elsewhere: Mapping[Ring, str] = MappingProxyType({})) -> None:
        members = [graph.activities[i] for i in deadlock.ring]
        # What only the source code shows must have lasted: a setter may be about to run.
        if deadlock.is_likely and not all(_is_old(a) for a in members):
            return
        ring, mine = frozenset(deadlock.ring), self._process.session.zid
        # One that was reported may have grown since, and another ring of it be found.
        reporters = {**elsewhere, **dict.fromkeys(self.reports, mine)}
        told = next((known for known in reporters if known & ring), ring)
        core = members if told == ring else [graph.activities[i] for i in sorted(told & set(graph.activities))]
        who = " and ".join(title(a) for a in core)
        behind = [graph.activities[i] for i in (ring | {*deadlock.victims}) - told]
        victims = {title(a) for a in behind if a.process == mine}
        if self.policy == "break" and not deadlock.is_likely:
            self._break(deadlock, graph)
        processes = {a.process for a in core}
        first = reporters.get(told) or min(processes - set(graph.blocked) or processes)
        if first != mine and told not in {*self._behind, *elsewhere}:
            self._process.session.ask_reports(answer_key(self._process.domain, LOOK, first), PULL_LIMIT, _nothing)
        held = frozenset((a.id, a.wait) for a in core if a.process == mine)
        if held and first != mine and told not in self._foreign:
            self._foreign[told] = Foreign(first, who, processes, held)
            own = " and ".join(f"{title(a)} ({a.line} in {a.function})" for a in core if a.process == mine)
            there = next((a.node for a in core if a.process == first), "another process")
            logger.warning("%s waits in a deadlock: the log of %s explains it, and says when it is over", own, there)
            if not self._is_watching:
                self._is_watching = True
                self._process.on_change(self._changed)
        is_first = told not in self._behind and self._count(_lines(core)) == 1
        if first == mine and told not in self.reports:
            involved = {a.process for a in behind} | processes
            in_vain, text = is_in_vain(deadlock, graph), explanation(deadlock, graph)
            calls = {activity.id: _called(activity) for activity in members}
            self.reports[ring] = Report(text, who, involved, deadlock.ring, in_vain, calls)
            if is_first:
                logger.log(logging.WARNING if in_vain else logging.ERROR, "%s", text)
            elif not in_vain:
                logger.error("%s", again(headline(deadlock, graph), self._told.get(_lines(members), 2)))
            self._behind[ring] = victims
        if told not in self._behind and not is_first:
            self._behind[told] = victims
        for victim in sorted(victims - self._behind.setdefault(told, set())):
            known = self.reports.get(told)
            logger.warning("%s waits behind the deadlock of %s", victim, who if known is None else known.who)
        self._behind[told] |= victims

    def _count(self, key: Hashable) -> int:
        """How often this has been told, now included."""
        times = self._told.pop(key, 0) + 1
        self._told[key] = times
        if len(self._told) > TOLD_BOUND:
            del self._told[next(iter(self._told))]
        return times

    def _is_reported(self, ring: Ring) -> bool:
        """Whether a deadlock, or another ring through one of its members, has been reported and stands."""
        return any(ring & known for known in self.reports)

    def _break(self, deadlock: Deadlock, graph: WaitGraph) -> None:
        """End the youngest call or goal of the ring, if it is this process's: all find the ring and agree on one."""
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

    def _take_back(self, graph: WaitGraph, dead: set[str], processes: set[str]) -> None:
        """Take back reports of rings that no longer exist.

        Args:
            processes: The processes that were looked at. Nothing is known about others.
        """
        for ring, report in list(self.reports.items()):
            unknown = report.processes - processes
            stands = is_ring(report.order, graph, dead) and not report.is_another(graph)
            if stands or any(entity.zid in unknown for entity in self._process.cache):
                continue
            del self.reports[ring]
            self._behind.pop(ring, None)
            if not ring <= dead and not report.is_in_vain:  # otherwise they are in another, which is reported now
                logger.warning("the deadlock of %s has cleared", report.who)

    def _forget_foreign(self, graph: WaitGraph) -> None:
        """Forget deadlocks that others report and whose waits here have been over for a while: they have cleared.

        Not at once: the process that was to say so may have gone, and its calls end before its tokens do.
        """
        now_ns, known = self._process.clock.monotonic_ns(), graph.activities
        for ring, foreign in list(self._foreign.items()):
            if all(name in known and known[name].wait == wait for name, wait in foreign.waits):
                self._loosened.pop(ring, None)
            elif now_ns - self._loosened.setdefault(ring, now_ns) >= to_ns(0.999 * FORGET_AFTER):
                del self._foreign[ring], self._loosened[ring]

    def _changed(self, change: GraphChange) -> None:
        """A process that must report a deadlock may be going, and the deadlock with it."""
        if change.alive:
            return
        leaving = {ring for ring, foreign in self._foreign.items() if foreign.reporter == change.entity.zid}
        for ring in leaving:
            foreign, clock = self._foreign.pop(ring), self._process.clock
            self._loosened.pop(ring, None)
            clock.call_at(clock.monotonic_ns() + to_ns(GONE_AFTER), partial(self._say_gone, ring, foreign))

    def _say_gone(self, ring: Ring, foreign: Foreign) -> None:
        there = {entity.zid for entity in self._process.cache}
        if foreign.reporter in there:
            self._foreign[ring] = foreign  # something else of that process went
        elif not self._is_closed and self._process.session.zid == min(foreign.processes & there, default=""):
            logger.warning("the deadlock of %s has cleared: one of its processes has gone", foreign.who)

    def look_now(self) -> None:
        """Another process has found a deadlock that this one must report. Callable from any thread."""
        if self.policy != "off":
            with suppress(RuntimeError):  # the loop is closed
                self._process.loop.call_soon_threadsafe(self._pull)

    def _probe_blocked(self) -> None:
        """The event loop is blocked: look from the thread that noticed it."""
        if self.policy == "off" or not self._lock.acquire(blocking=False):
            return
        try:
            graph = self.snapshot.take()
            for deadlock in explained(graph, deadlocked(graph)):
                self._tell(deadlock, graph)
                self._process.loop.call_soon_threadsafe(self.arm)  # to see it cleared
        except Exception as error:  # the thread that looks must go on looking
            logger.debug("the search for deadlocks: %r", error, exc_info=error)
        finally:
            self._lock.release()


def _lines(members: list[ActivityView]) -> frozenset[tuple[str, Place]]:
    """What a deadlock is known by when it comes again: its members, and the lines in which they wait."""
    return frozenset((title(activity), activity.place) for activity in members)


def _called(activity: ActivityView) -> list[str]:
    return [call.name for call in calls_of(activity.wait)]


def _nothing(*_: object) -> None:
    """Ignores the answers."""


def _is_asked(graph: WaitGraph) -> bool:
    """Whether another process waits for what this one must answer."""
    activities, queues = graph.activities.values(), graph.queues.values()
    asked = {call for queue in queues for call in queue.calls} | {a.serves for a in activities if a.serves}
    return not asked.issubset(call.id for a in activities for call in calls_of(a.wait))


def _is_old(activity: ActivityView) -> bool:
    """Whether an activity has waited long enough to be looked at."""
    return activity.age >= 0.999 * PROBE_AFTER
