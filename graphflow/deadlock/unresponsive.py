"""Unresponsive processes: something here waits for them, and they do not answer the search.

They are stopped, unreachable, or inside a C extension that holds the GIL. Nothing is known about their waits, so they
count as alive and no deadlock is found; but users must learn why others wait for them.
"""

from __future__ import annotations

import logging

from graphflow.deadlock.protocols import ProcessContext
from graphflow.machines.waits.explain import title, where
from graphflow.machines.waits.wait_graph import ActivityView, WaitGraph, calls_of
from graphflow.times import NANOSECONDS
from graphflow.transport.base import Closable
from graphflow.wire import process
from graphflow.wire.liveliness import Kind
from graphflow.wire.process import ProcessToken

logger = logging.getLogger("graphflow")

SILENT_AFTER = 1.0
"""Seconds between two unanswered questions after which a process is reported."""


class Unresponsive:
    """The awaited processes that did not answer. One per process."""

    def __init__(self, here: ProcessContext) -> None:
        self._here = here
        self._processes: dict[str, ProcessToken] = {}
        self._since: dict[str, int] = {}
        """Time at which each silent process was first found silent, in nanoseconds."""
        self._reported: set[str] = set()
        self._watch: Closable | None = None

    def __bool__(self) -> bool:
        """Whether any process is silent."""
        return bool(self._since)

    def compare(self, mine: WaitGraph, answered: set[str]) -> None:
        """Compare the awaited processes with those that answered when all were asked; report the silent ones.

        Args:
            mine: The waits of this process.
            answered: The sessions that answered.
        """
        if self._watch is None:  # tokens of existing processes arrive soon, in time for the next comparison
            domain = self._here.domain
            self._watch = self._here.session.watch(process.watch_key(domain), self._changed)
        for zid in answered.intersection(self._since):
            self._goes_on(zid, "answers again")
        now = self._here.clock.monotonic_ns()
        for zid, (activity, name) in self._waited_for(mine).items():
            if zid in answered or zid not in self._processes:
                continue
            seconds = (now - self._since.setdefault(zid, now)) / NANOSECONDS
            if seconds >= SILENT_AFTER and zid not in self._reported:
                self._reported.add(zid)
                server = self._processes[zid]
                text = (
                    f"NODE UNRESPONSIVE: {self._nodes(zid)} ({server}) has not answered for {seconds:.1f} s, and "
                    f"{title(activity)} waits for {name} {where(activity)}: {server.why_silent}"
                )
                logger.warning("%s", text)

    def _waited_for(self, mine: WaitGraph) -> dict[str, tuple[ActivityView, str]]:
        """Return the sessions that must answer calls, each with one activity that waits, and the name it waits for."""
        found: dict[str, tuple[ActivityView, str]] = {}
        for activity in mine.activities.values():
            for call in calls_of(activity.wait):
                name = f"{call.name}/_action/send_goal" if call.id.startswith("goal:") else call.name
                for server in self._here.cache.endpoints(Kind.SERVICE, name):
                    found.setdefault(server.zid, (activity, call.name))
        found.pop(self._here.session.zid, None)
        return found

    def _nodes(self, zid: str) -> str:
        names = sorted({e.node_name for e in self._here.cache if e.zid == zid and not e.node_name.startswith("/_")})
        return " and ".join(names) or "a process without nodes"

    def _changed(self, text: str, alive: bool) -> None:
        token = process.parse(text)
        if token is None:
            return
        if alive:
            self._processes[token.zid] = token
        else:
            self._goes_on(token.zid, "has gone")
            self._processes.pop(token.zid, None)

    def _goes_on(self, zid: str, how: str) -> None:
        self._since.pop(zid, None)
        if zid in self._reported:
            self._reported.discard(zid)
            logger.warning("%s (%s) %s", self._nodes(zid), self._processes[zid], how)
