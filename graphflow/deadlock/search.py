"""The search for deadlocks: when to take snapshots, and whom to ask.

**When.** The search costs nothing while nothing waits. A call, or work that finds no slot, arms a probe a quarter of
a second later, and so does the start of a task. Waits that still last are probed again at growing intervals.

**Whom.** A deadlock within one process shows in one snapshot of it. If old waits lead out of the process, all processes
are asked for their snapshots, twice, which rules out phantoms (see `machines.waits.reduction`). A process that does not
answer counts as alive.

Deadlocks that are found go to the `Reporter`, which decides whether this process is the one to report them.
"""

from __future__ import annotations

import json
import logging
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import NamedTuple

from graphflow.deadlock.chains import Chains
from graphflow.deadlock.protocols import ProcessContext
from graphflow.deadlock.reporting import PROBE_AFTER, PULL_LIMIT, Reporter, Ring, is_old, lines_of
from graphflow.deadlock.snapshot import Snapshot
from graphflow.deadlock.stalls import Stalls
from graphflow.deadlock.unresponsive import SILENT_AFTER, Unresponsive
from graphflow.deadlock.watchdog import Watchdog
from graphflow.executor.clock import Alarm
from graphflow.executor.ledger import PendingCall
from graphflow.executor.runner import Runner
from graphflow.interface import DeadlockPolicy
from graphflow.machines.waits.explain import again, hopeless
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import explained
from graphflow.machines.waits.transform_waits import resolved
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    Condition,
    Opening,
    TransformWait,
    WaitGraph,
    calls_of,
    joined,
    parts_of,
)
from graphflow.machines.waits.wait_graph_json import from_json
from graphflow.times import to_ns
from graphflow.wire.process import WAITS, answer_key

logger = logging.getLogger("graphflow")

PROBE_LONGEST = 8.0
"""Longest interval in seconds between two probes of the same waits."""
TASKS_EVERY = 2.0
"""Seconds between two probes of tasks, whose waits are not announced, while nothing else waits."""


class Round(NamedTuple):
    """The joint result of one round of questions to all processes."""

    graph: WaitGraph
    """Waits of this process and of those that answered."""
    answered: set[str]
    """Processes whose waits `graph` includes."""
    reported: dict[Ring, str]
    """Existing deadlocks that other processes have reported, with the reporter."""


class Search:
    """The search for deadlocks with a member in this process. One per process."""

    def __init__(self, process: ProcessContext, policy: DeadlockPolicy) -> None:
        self._process = process
        self.policy = policy
        self.is_on = policy != "off"
        """Whether the search is on."""
        self.is_armed = policy == "off"
        """Whether a probe is due soon; always true when the search is off, so that `arm` returns at once."""
        self.pulls = 0
        """Number of rounds of questions to other processes."""
        self._reporter = Reporter(process, policy)
        self.reports = self._reporter.reports
        self.stalls = Stalls()
        self.watchdog = Watchdog(process.loop, self._probe_blocked)
        self.snapshot = Snapshot(process, self.watchdog)
        self._chains = Chains(process.ledger, process.session.zid)
        self._unresponsive = Unresponsive(process)
        self._dead: set[str] = set()
        """Activities that were dead in the last joint round."""
        self._period = PROBE_AFTER
        self._grown_ns = 0
        """Time at which the period was last made longer."""
        self._alarm: Alarm | None = None
        self._last: set[tuple[str, Condition]] = set()
        self._lock = threading.Lock()
        self._is_closed = False
        process.ledger.alert = self.arm

    # the interface to the runtime

    def arm(self) -> None:
        """Probe soon, since something waits. Called for every call and stall; nearly free when a probe is due."""
        if not self.is_armed:
            self._period = PROBE_AFTER
            self._schedule(PROBE_AFTER)

    def chain(self, call: PendingCall) -> bytes:
        """Return the chain of calls that led to a call, to be sent along with it for `hopeless` at its server."""
        return self._chains.of(call) if self.is_on else b""

    def hopeless(self, service: str, runner: Runner, asked: bytes) -> str:
        """Return the report with which a queued request must fail; empty if it may be answered.

        It can never be answered if the server's group is full of runs that wait for this very request. Only under the
        policies `raise` and `break`.

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
        times = self._reporter.count((service, *lines_of(found)))
        return text if times == 1 else again(text.partition("\n")[0], times)

    def has_reported(self, activity: str, title: str) -> bool:
        """Whether an activity of this process was reported, as a member of a deadlock or as its victim."""
        return self._reporter.has_reported(activity, title)

    def close(self) -> None:
        """Stop the search."""
        self._is_closed = True
        self._reporter.close()
        self.watchdog.close()
        if self._alarm is not None:
            self._alarm.cancel()
        # From now on, `arm` returns at once.
        self.is_armed = True

    # probes

    def _schedule(self, seconds: float) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
        self.is_armed = seconds <= PROBE_AFTER
        clock = self._process.clock
        self._alarm = clock.call_at(clock.monotonic_ns() + to_ns(seconds), self._probe)

    def _probe(self) -> None:
        """Search once, and schedule the next probe."""
        try:
            self._search_here()
        except Exception as error:  # a bug in the search must neither end it nor reach the program it observes
            logger.debug("the search for deadlocks: %r", error, exc_info=error)
            self._schedule(PROBE_LONGEST)

    def _search_here(self) -> None:
        """Search this process, and all others if its waits lead there."""
        seen = self.snapshot.take()
        graph, mine = resolved(seen), self._process.session.zid
        dead = deadlocked(graph)
        # Ends come first: a ring that has cleared must not keep a new one of the same members from being reported.
        self._reporter.take_back(graph, dead, {mine})
        if any(report.processes != {mine} for report in self.reports.values()):
            self._ask(self._recheck)
        self._reporter.forget_foreign(graph)
        waiting = {(a.id, a.wait) for a in seen.activities.values() if a.wait is not FREE}
        if not waiting and not any(q.waiting for q in graph.queues.values()):
            self._rest(graph)
            return
        found = explained(graph, dead)
        # If other processes wait for this one, a joint round sees more of the deadlock, and its report is complete.
        is_wider = _is_awaited(graph) and not all(self._reporter.is_known(frozenset(d.ring)) for d in found)
        for deadlock in () if is_wider else found:
            self._reporter.report(deadlock, graph)
        if is_wider or any(self._leaves(a, seen) for a in seen.activities.values() if is_old(a)):
            self._pull()
        self._adapt_period(waiting)
        young = [a.age for a in seen.activities.values() if a.wait is not FREE and not is_old(a)]
        soonest = [PROBE_AFTER - max(young)] if young else []
        soonest += [SILENT_AFTER] if self._unresponsive else []
        soonest += self._check_stalls(graph, dead | self._dead)
        self._schedule(min(max(min(soonest, default=self._period), 0.01), self._period))

    def _rest(self, graph: WaitGraph) -> None:
        """Wait to be armed again, since nothing waits; tasks alone are probed now and then."""
        self.is_armed = not self.is_on
        self._last.clear()
        self._reporter.forget_victims()
        self._check_stalls(graph, set())
        again = self._reporter.looks_again_in
        if again is not None or any(node.tasks for node in self._process.nodes):
            self._schedule(TASKS_EVERY if again is None else again)

    def _adapt_period(self, waiting: set[tuple[str, Condition]]) -> None:
        """Probe new waits soon, and the same ones at intervals that double."""
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

    def _check_stalls(self, graph: WaitGraph, dead: set[str]) -> list[float]:
        due = self.stalls.look(graph, dead, self._process.clock.monotonic_ns())
        return [] if due is None else [due]

    def _leaves(self, activity: ActivityView, graph: WaitGraph) -> bool:
        """Whether an activity waits for another process."""
        here = {a.serves for a in graph.activities.values()} | {c for q in graph.queues.values() for c in q.calls}
        opening = {service for queue in graph.queues.values() for service in queue.opens}
        wanted = [part.service for part in parts_of(activity.wait) if isinstance(part, Opening)]
        mine = self._process.session.zid
        transforms = [part for part in parts_of(activity.wait) if isinstance(part, TransformWait)]
        if any(process != mine for part in transforms for process in part.processes):
            return True
        calls = calls_of(activity.wait)
        return any(c.id not in here or c.servers > 1 for c in calls) or not opening.issuperset(wanted)

    # other processes

    def _pull(self) -> None:
        """Ask all processes for their snapshots, in two rounds.

        The callback may run early, with the replies so far, if some processes are slow. One that does not answer counts
        as alive; so if the early replies suffice for a deadlock with a member here, the second round begins at once.
        """
        is_second_due = False

        def first(replies: list[bytes], is_all: bool) -> None:
            nonlocal is_second_due
            before = self._joint(replies)
            if is_all:
                self._unresponsive.compare(self.snapshot.take(), before.answered)
            dead = () if is_second_due else deadlocked(before.graph)
            if any(self._process.session.zid == before.graph.activities[i].process for i in dead):
                is_second_due = True
                self._ask(lambda again, _: self._conclude(before.graph, self._joint(again)))

        self._ask(first)

    def _ask(self, receive: Callable[[list[bytes], bool], None]) -> None:
        """Ask all processes; `receive` gets the replies so far, and whether there will be no more."""
        if self._is_closed:
            return

        def receive_open(replies: list[bytes], is_all: bool) -> None:
            if not self._is_closed:  # it may close meanwhile
                receive(replies, is_all)

        self.pulls += 1
        self._process.session.ask_reports(answer_key(self._process.domain, WAITS), PULL_LIMIT, receive_open)

    def _joint(self, replies: list[bytes]) -> Round:
        """Merge the snapshots of the processes that answered with this one's."""
        graphs, answered, reported = [], {self._process.session.zid}, dict[Ring, str]()
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
            reported |= dict.fromkeys(rings, process)
        return Round(resolved(joined([*graphs, self.snapshot.take()])), answered, reported)

    def _recheck(self, replies: list[bytes], is_all: bool) -> None:
        """Take back reports whose rings no longer exist in other processes."""
        if not is_all:
            return
        now = self._joint(replies)
        self._reporter.take_back(now.graph, deadlocked(now.graph), now.answered)

    def _conclude(self, before: WaitGraph, now: Round) -> None:
        """Report the deadlocks that both rounds show."""
        self._dead = deadlocked(now.graph, before)
        reported = self._reporter.left_to_silent(now.answered) | now.reported
        for deadlock in explained(now.graph, self._dead):
            self._reporter.report(deadlock, now.graph, reported)
        if self.reports:  # probe again soon, to report their end
            self._schedule(min(self._period, 2 * PROBE_AFTER))

    def look_now(self) -> None:
        """Search at once, since another process has found a deadlock to report here. Callable from any thread."""
        if self.policy != "off":
            with suppress(RuntimeError):  # the loop is closed
                self._process.loop.call_soon_threadsafe(self._pull)

    def _probe_blocked(self) -> None:
        """Search on the watchdog's thread while the event loop is blocked."""
        if self.policy == "off" or not self._lock.acquire(blocking=False):
            return
        try:
            graph = resolved(self.snapshot.take())
            for deadlock in explained(graph, deadlocked(graph)):
                self._reporter.report(deadlock, graph)
                self._process.loop.call_soon_threadsafe(self.arm)  # to report its end
        except Exception as error:  # a bug in the search must not end the watchdog's thread
            logger.debug("the search for deadlocks: %r", error, exc_info=error)
        finally:
            self._lock.release()


def _is_awaited(graph: WaitGraph) -> bool:
    """Whether other processes wait for answers of this one."""
    activities, queues = graph.activities.values(), graph.queues.values()
    requested = {call for queue in queues for call in queue.calls} | {a.serves for a in activities if a.serves}
    return not requested.issubset(call.id for a in activities for call in calls_of(a.wait))
