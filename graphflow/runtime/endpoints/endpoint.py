"""The base class of endpoints: a full name, a liveliness token, counterparts, and an open/close life cycle."""

from __future__ import annotations

import sys
from abc import abstractmethod
from asyncio import Future
from collections import Counter, deque
from collections.abc import Callable

from graphflow.analysis.syntax import syntax_of
from graphflow.analysis.user_code import is_users, users_frame
from graphflow.errors import ClosedError, DecodeError
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.machines.cache import GraphChange
from graphflow.machines.matching import verdict
from graphflow.msgs import registry
from graphflow.qos import Qos
from graphflow.runtime.endpoints.events import OnEvent, QosEvent, QosEventKind
from graphflow.runtime.part import Host, Part
from graphflow.times import to_ns
from graphflow.transport.base import Closable
from graphflow.wire.liveliness import Entity, Kind

COMPLAIN_EVERY = 10.0
"""Seconds before the same complaint about a counterpart is logged again."""
COMPLAINTS = 100
"""Complaints kept for suppression."""


class Endpoint(Part):
    """An endpoint of a node under one name, from `open` to `close`.

    Args:
        on_event: Called with each `QosEvent`, one at a time; a `def` or an `async def`.
        type_hash: The type's RIHS01 hash, if its definition is not known here.
    """

    kind: Kind
    sensor_example = ""
    """The code for a subscription to a sensor's topic, as a format string of the type's name and the topic's."""

    def __init__(
        self,
        host: Host,
        type_name: str,
        name: str,
        qos: Qos,
        on_event: OnEvent | None = None,
        type_hash: str = "",
    ) -> None:
        self.host = host
        self.type_name = type_name
        self.name = name
        """The full name after remapping."""
        self.qos = qos
        self.entity: Entity | None = None
        """The announced entity; None until the node runs."""
        self.matched: dict[str, Entity] = {}
        """The matched counterparts in the graph, by token."""
        self._awaited: set[Future[None]] = set()
        """Futures of waits for counterparts; done when one appears or leaves."""
        self._type_hash = type_hash
        self._declared: list[Closable] = []
        self._on_event = on_event
        self._event_runner: Runner | None = None
        self._events: deque[QosEvent] = deque()
        self._event_totals: Counter[QosEventKind] = Counter()
        self._stop_listening: Callable[[], None] = _nothing
        self.malformed = 0
        """Payloads that were not a valid message of the type and were dropped."""
        self._complained: dict[str, int] = {}
        """For each complaint: the end of its silence, in nanoseconds."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name} [{self.type_name}]>"

    @property
    def title(self) -> str:
        return f"{self.kind.name.lower()} {self.name}"

    def statistics(self) -> dict[str, object]:
        return {
            "matched": len(self.matched),
            **{kind: n for kind, n in self._event_totals.items() if kind != "matched"},
        }

    def count_malformed(self, error: DecodeError) -> None:
        """Count a payload that is not a valid message of the type."""
        self.malformed += 1
        if self.malformed == 1 or self.malformed % 1000 == 0:
            self.host.log.warning("%s: dropped a malformed message (%d so far): %s", self.name, self.malformed, error)

    @property
    def endpoints(self) -> tuple[Endpoint, ...]:
        return (self,)

    @property
    def is_open(self) -> bool:
        return self.entity is not None

    def open(self) -> None:
        """Declare the endpoint on the network, then announce it. Called by the node."""
        context, host = self.host.context, self.host
        there = context.cache.named(self.name)
        # Before the token is made: peers of ROS 2 drop one that has the number of BEST_AVAILABLE.
        self.qos = self.qos.adapted(e.qos for e in there if {e.kind, self.kind} == {Kind.PUBLISHER, Kind.SUBSCRIPTION})
        self.entity = Entity(
            context.domain,
            context.session.zid,
            host.id,
            context.next_id(),
            self.kind,
            host.namespace,
            host.name,
            self.name,
            self.type_name,
            self._type_hash or registry.hash_of(self.type_name),
            self.qos,
        )
        if self._on_event is not None:
            spec = RunnerSpec(f"events of {self.name}", self._on_event, self._event_handled, host.full_name)
            self._event_runner = host.runner(spec, self._events)
        self._open(self.entity.data_key)
        # Announced last, so that a process that sees the token can already reach the endpoint.
        self._declared.append(context.session.announce(self.entity.token))
        self._stop_listening = context.on_name(self.name, self._counterpart)
        for entity in there:
            self._counterpart(GraphChange(entity, True))
        if not self.matched:
            context.unmatched.opened(self.entity, host.log)

    @abstractmethod
    def _open(self, key: str) -> None:
        """Declare the endpoint on the network under its data key."""

    def close(self) -> None:
        self._stop_listening()
        self._stop_listening = _nothing
        declared, self._declared = self._declared, []
        for closable in reversed(declared):
            closable.close()
        if self._event_runner is not None:
            self._event_runner.cancel()
        for awaited in self._awaited:
            if not awaited.done():
                awaited.set_exception(ClosedError(f"{self.name} was closed while its counterparts were waited for"))
        self.matched.clear()
        self.entity = None
        self.host.forget(self)

    async def wait_matched(self, count: int = 1) -> None:
        """Wait until `count` counterparts are matched: for a publisher, that many subscriptions.

        Raises:
            ClosedError: The node is not running, or stops during the wait.
        """
        self._announced()
        while len(self.matched) < count:
            self._awaited.add(change := self.host.context.loop.create_future())
            try:
                await change
            finally:
                self._awaited.discard(change)

    def event_total(self, kind: QosEventKind) -> int:
        """Return the number of events of a kind since the start."""
        return self._event_totals[kind]

    def _counterpart(self, change: GraphChange) -> None:
        """Handle the appearance or departure of an endpoint of the same name."""
        if not self.host.is_running:  # a stopped node leaves the network with its context
            return
        other = change.entity
        own = self._announced()
        judged = verdict(own, other, self.host.context.profile)
        if judged is None:
            return
        if judged.reaches and change.alive != (other.token in self.matched):
            if change.alive:
                self.matched[other.token] = other
            else:
                del self.matched[other.token]
            step = 1 if change.alive else -1
            for awaited in self._awaited:
                if not awaited.done():
                    awaited.set_result(None)
            self._tell("matched", int(change.alive), step, len(self.matched), other.node_name)
            self._matched(other, change.alive)
        if change.alive and judged.complaint:
            # Of two ends of a process, one complains.
            if other.zid != own.zid or own.kind in (Kind.SUBSCRIPTION, Kind.CLIENT):
                code = self.sensor_example.format(own.type.rpartition("/")[2], own.name)
                self._complain(judged.complaint + (code if judged.policies == ("reliability",) else ""))
            if judged.reaches:
                self._tell("incompatible_qos", detail=", ".join(judged.policies))
            else:
                self._tell("incompatible_type", detail=other.node_name)

    def _complain(self, text: str) -> None:
        """Log a problem with a counterpart, but not each time that the counterpart comes and goes."""
        now_ns = self.host.context.clock.monotonic_ns()
        if now_ns >= self._complained.get(text, 0):
            if len(self._complained) >= COMPLAINTS:
                self._complained.clear()
            self._complained[text] = now_ns + to_ns(COMPLAIN_EVERY)
            self.host.log.warning("%s", text)

    def _matched(self, other: Entity, alive: bool) -> None:
        """Handle the arrival or departure of a matched counterpart."""

    def _tell(
        self, kind: QosEventKind, more: int = 1, change: int | None = None, current: int = 0, detail: str = ""
    ) -> None:
        self._event_totals[kind] += more
        if self._event_runner is not None:
            total = self._event_totals[kind]
            self._events.append(QosEvent(kind, total, more if change is None else change, current, detail))
            self._event_runner.wake()

    def _event_handled(self, event: QosEvent, result: object, error: BaseException | None) -> None:
        if error is not None:
            self.host.handler_failed(f"event {event.kind} of {self.name}", error)

    def _announced(self) -> Entity:
        if self.entity is None:
            raise ClosedError(f"{self.name}: node {self.host.full_name} {_how_to_run()}")
        return self.entity


def _nothing() -> None:
    """Do nothing: there is no listener."""


def _how_to_run() -> str:
    """Say that a node does not run, and where its endpoints are used, from the code that uses one too early."""
    frame = users_frame(sys._getframe())
    while frame is not None:
        if frame.f_code.co_name == "__init__" and is_users(frame.f_code.co_filename):
            from graphflow.analysis.mistakes.calls.called_early import results_passed  # most programs never need it

            early = dict(results_passed(syntax_of(frame.f_code.co_filename).module, is_of_threads=False))
            cause = early.get(frame.f_lineno)
            way = f"line {frame.f_lineno}: {cause}" if cause else "do this in async def on_start(self), or in a handler"
            return f"does not run yet in __init__; {way}"
        frame = frame.f_back
    return (
        "is not running; use this from its handlers and tasks, which graphflow.run(node) runs, "
        "or in a script within async with graphflow.running(node):"
    )
