"""Duplicate names on the network: nodes with the name of one of this process, and services offered twice.

ROS 2's tools, and calls of parameters and services, then reach one of them by chance.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial

from graphflow.deadlock.protocols import ProcessContext
from graphflow.errors import printable
from graphflow.executor.clock import Alarm
from graphflow.machines.cache import GraphChange
from graphflow.machines.matching import shared
from graphflow.names import is_hidden
from graphflow.times import to_ns
from graphflow.transport.base import Closable
from graphflow.transport.config import reaches_out
from graphflow.wire import process
from graphflow.wire.process import ProcessToken

WARN_AFTER = 1.0
"""Seconds for a node of the same name to leave, as in a restart."""
NAMED = 3
"""Other processes named in a message."""
PROCESSES_BOUND = 10_000
logger = logging.getLogger("graphflow")


class Twins:
    """The duplicate names of a process's nodes and services, each reported once."""

    def __init__(self, here: ProcessContext) -> None:
        self._here = here
        self._known: set[str] = set()
        self._shared: set[str] = set()
        """Services to report."""
        self._reported: set[str] = set()
        """Services reported, of which there are no more than this process offers."""
        self._processes: dict[str, ProcessToken] = {}
        self._watch: Closable | None = None
        self._alarms: set[Alarm] = set()

    def changed(self, change: GraphChange) -> None:
        """Handle the appearance or departure of an endpoint or node."""
        name = change.entity.node_name
        if not change.alive or name in self._known or is_hidden(name):
            return
        if any(node.full_name == name for node in self._here.nodes) and len(self._here.cache.owners(name)) > 1:
            self._known.add(name)
            if self._watch is None:
                self._watch = self._here.session.watch(process.watch_key(self._here.domain), self._process)
            self._later(partial(self._report, name))

    def _later(self, report: Callable[[], None]) -> None:
        def due() -> None:
            self._alarms.discard(alarm)
            report()

        clock = self._here.clock
        alarm = clock.call_at(clock.monotonic_ns() + to_ns(WARN_AFTER), due)
        self._alarms.add(alarm)

    def _report(self, name: str) -> None:
        mine = self._here.session.zid
        owners = [entity.zid for entity in self._here.cache.owners(name)]
        if len(owners) < 2 or mine not in owners:
            self._known.discard(name)
            return
        others = {zid for zid in owners if zid != mine}
        named = sorted(map(self._owner, sorted(others)[:NAMED]))
        more = [f"{len(others) - NAMED} more"] if len(others) > NAMED else []
        where = " and ".join([*named, *more]) or "this process, too"
        rename = "rename one: --ros-args -r __node:=NAME, or name='NAME' in a launch file" if others else "rename one"
        text = "another node is called %s, in %s: parameters, services and tools reach one of them by chance; %s"
        logger.warning(text, name, where, rename)

    def share(self, name: str) -> None:
        """Note that another node offers a service of this process."""
        if not self._shared:
            self._later(self._report_shared)
        self._shared.add(name)

    def _report_shared(self) -> None:
        names, self._shared = self._shared - self._reported, set()
        offered = {name: self._here.cache.named(name) for name in names}
        self._reported |= {name for name, entities in offered.items() if shared(entities)}
        for text in shared(entity for entities in offered.values() for entity in entities):
            logger.warning("%s", text)

    def _owner(self, zid: str) -> str:
        token = self._processes.get(zid)
        if token is None:
            other = "no graphflow process, or on another machine" if reaches_out() else "no graphflow process"
            return f"session {zid}, {other}"
        return f"{token} ({printable(token.command)})" if token.command else str(token)

    def _process(self, text: str, alive: bool) -> None:
        token = process.parse(text)
        if token is None:
            return
        if not alive:
            self._processes.pop(token.zid, None)
        elif len(self._processes) < PROCESSES_BOUND:
            self._processes[token.zid] = token

    def close(self) -> None:
        """Stop reporting: the graph no longer changes."""
        for alarm in self._alarms:
            alarm.cancel()
        if self._watch is not None:
            self._watch.close()
