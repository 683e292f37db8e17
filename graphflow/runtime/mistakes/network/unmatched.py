"""Topics and services without a counterpart, probably because of a wrong name or domain.

Publishers and subscriptions without a counterpart are legal. So a warning requires that a topic of the same type and a
similar name has the missing counterpart, or that the node is alone in its domain while another domain has the
counterpart.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from graphflow.deadlock.protocols import ProcessContext
from graphflow.executor.clock import Alarm
from graphflow.machines.cache import ACTION_SEND_GOAL, GraphChange
from graphflow.machines.matching import COUNTERPARTS
from graphflow.machines.near_topics import by_type, did_you_mean_topic, of_other_kind
from graphflow.names import is_everybodys, is_hidden
from graphflow.qos import Durability
from graphflow.runtime.mistakes.network.other_domains import look_elsewhere
from graphflow.times import to_ns
from graphflow.wire.liveliness import Entity, Kind

WARN_AFTER = 3.0
"""Seconds for the counterpart to appear."""
AT_ONCE = 8
"""Endpoints checked per iteration of the event loop."""
LATE = 1.0
"""Longest delay of a check, in seconds: after a longer block, the loop has not yet processed new tokens."""


@dataclass
class _Waiting:
    """A publisher, subscription or client without a counterpart."""

    log: logging.Logger
    due_ns: int | None
    """The time of the next check; None if no endpoint of its type has appeared since the last one."""


class Unmatched:
    """The endpoints of a process without a counterpart, each reported once, and the domain once.

    An endpoint is checked `WARN_AFTER` seconds after it was opened, and after a possible counterpart has appeared. One
    per process.
    """

    def __init__(self, here: ProcessContext) -> None:
        self._here = here
        self._waiting: dict[str, dict[Entity, _Waiting]] = {}
        """Endpoints without a counterpart, by type."""
        self._reported: set[tuple[str, Kind, str]] = set()
        """The reported endpoints by node, kind and topic, of which there are no more than this process has."""
        self._alarm: Alarm | None = None
        self._is_domain_reported = self._is_closed = False

    def opened(self, own: Entity, log: logging.Logger) -> None:
        """Note that a node of this process has opened an endpoint."""
        name = own.name.removesuffix(ACTION_SEND_GOAL)
        if self._is_closed or own.kind is Kind.SERVICE or is_everybodys(name) or is_hidden(own.node_name):
            return
        keeps = own.kind is Kind.PUBLISHER and own.qos.durability is Durability.TRANSIENT_LOCAL
        if not keeps and (own.node_name, own.kind, own.name) not in self._reported:
            self._waiting.setdefault(own.type, {})[own] = _Waiting(log, self._due())

    def changed(self, change: GraphChange) -> None:
        """Handle the appearance or departure of an endpoint."""
        other = change.entity
        for own, waiting in [*self._waiting.get(other.type, {}).items()] if change.alive else ():
            if other.kind is COUNTERPARTS[own.kind] and other.name == own.name:
                self._forget(own)
            elif other.kind is COUNTERPARTS[own.kind] and waiting.due_ns is None:
                waiting.due_ns = self._due()

    def _due(self) -> int:
        """Schedule the next check; returns its time."""
        clock = self._here.clock
        due_ns = clock.monotonic_ns() + to_ns(WARN_AFTER)
        if self._alarm is None:
            self._alarm = clock.call_at(due_ns, self._check)
        return due_ns

    def _check(self) -> None:
        now_ns, cache = self._here.clock.monotonic_ns(), self._here.cache
        self._alarm = None
        due: list[tuple[Entity, _Waiting]] = []
        for own, waiting in [pair for same in self._waiting.values() for pair in same.items()]:
            if own.token not in cache:  # the endpoint was closed
                self._forget(own)
            elif waiting.due_ns is not None and waiting.due_ns + to_ns(LATE) < now_ns:
                waiting.due_ns = self._due()
            elif waiting.due_ns is not None and waiting.due_ns <= now_ns:
                due.append((own, waiting))
        self._check_all(due[:AT_ONCE])
        left = [w.due_ns for same in self._waiting.values() for w in same.values() if w.due_ns is not None]
        if left and self._alarm is None:
            self._alarm = self._here.clock.call_at(min(left), self._check)

    def unheard(self, node: str) -> str:
        """Return the names that a node's subscriptions may have meant, for a node that ends before the check."""
        waiting = [own for same in self._waiting.values() for own in same if own.node_name == node]
        subscriptions = [own for own in waiting if own.kind is Kind.SUBSCRIPTION and own.token in self._here.cache]
        there = by_type(self._here.cache, {own.type for own in subscriptions})
        texts = {own: text for own in subscriptions if (text := did_you_mean_topic(own, there))}
        for own in texts:
            self._forget(own)
        return " ".join(texts.values())

    def _check_all(self, due: Sequence[tuple[Entity, _Waiting]]) -> None:
        there = by_type(self._here.cache, {own.type for own, _ in due})
        for own, waiting in due:
            waiting.due_ns = None
            text = of_other_kind(own, self._here.cache.named(own.name)) or did_you_mean_topic(own, there)
            if text:
                self._forget(own)
                self._reported.add((own.node_name, own.kind, own.name))
                waiting.log.warning("%s", text)
        logs = {own.node_name: waiting.log for own, waiting in due}
        for name, log in logs.items() if not self._is_domain_reported else ():
            lacking = [own for same in self._waiting.values() for own in same if own.node_name == name]
            if lacking:
                look_elsewhere(self._here, name, partial(self._report_domain, log), lacking)

    def _report_domain(self, log: logging.Logger, text: str) -> None:
        if text and not self._is_domain_reported and not self._is_closed:
            self._is_domain_reported = True
            log.warning("%s", text)

    def _forget(self, own: Entity) -> None:
        same = self._waiting[own.type]
        del same[own]
        if not same:
            del self._waiting[own.type]

    def close(self) -> None:
        """Stop reporting."""
        self._is_closed = True
        self._waiting.clear()
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
