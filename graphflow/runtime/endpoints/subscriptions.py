"""Subscriptions: decode messages, and pass them to a callback or an iteration."""

from __future__ import annotations

import asyncio
import struct
from asyncio import Future
from collections.abc import AsyncIterator, Callable
from inspect import iscoroutinefunction
from time import monotonic
from typing import Any, Generic, TypeVar

from graphflow.errors import ClosedError, DecodeError
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import SLICE, Runner, RunnerSpec, title_of
from graphflow.interface import OnError
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.qos import INFINITE_NS, Durability, Liveliness, Qos
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.events import OnEvent, SilenceTimer
from graphflow.runtime.endpoints.intra_process import Handed
from graphflow.runtime.endpoints.shared_memory import RingReading
from graphflow.runtime.endpoints.sources import Leases, Source, end_lease
from graphflow.runtime.mistakes.echoes import Echo, check_ignored, echo_of
from graphflow.runtime.mistakes.expiry import Expiry
from graphflow.runtime.mistakes.losses import MANY_LOSSES, Losses
from graphflow.runtime.mistakes.shared_reading import SharedReading
from graphflow.runtime.part import Host
from graphflow.transport.inbox import DeepInbox, Inbox, open_inbox
from graphflow.wire import attachment
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

M = TypeVar("M", bound=Message)

SOURCES_BOUND = 4096
"""Publishers tracked by a subscription."""
_NEWEST = ("latest", "last", "value", "message", "msg", "get", "read", "receive")
_NO_INFO = (0, 0, bytes(16))
"""The fields of a missing attachment, or of one with another layout."""


class TopicSubscription(Endpoint, Generic[M]):
    """A subscription with a callback, or to be iterated: `async for message in subscription`.

    Args:
        takes_info: Whether the callback also takes the message's `MessageInfo`.
        ignore_local: Whether to skip messages that this process publishes.
    """

    kind = Kind.SUBSCRIPTION
    latched_profile = "Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)"
    sensor_example = ', as in @subscription({}, "{}", SENSOR_DATA), from graphflow.qos'
    in_order = False
    """Whether responses sent after a message must not overtake it."""

    def __init__(
        self,
        host: Host,
        type_: type[M],
        name: str,
        qos: Qos,
        callback: Callable[..., Any] | None = None,
        label: str = "",
        group: HandlerGroup | None = None,
        *,
        takes_info: bool = False,
        ignore_local: bool = False,
        on_event: OnEvent | None = None,
        on_error: OnError = "budget",
    ) -> None:
        super().__init__(host, type_.SCHEMA.name, name, qos, on_event)
        self.type = type_
        self.opened_ns = 0
        """The wall-clock time of its opening."""
        self._expiry = Expiry(host, name)
        self._reading: SharedReading | None = None
        self._callback, self._takes_info, self._ignore_local = callback, takes_info, ignore_local
        self._label = label or f"subscription {name}"
        self._group, self._on_error = group, on_error
        self._codec = registry.codec(self.type_name)
        self._read: Callable[[Any], tuple[bytes, bytes | None]] = unreadable
        self.runner: Runner | None = None
        self._inbox: Inbox | None = None
        self._taken, self._turn_ends = 0, 0.0
        """Messages that were read, and when their reader has to give the loop a turn, on the monotonic clock."""
        self._waiters: set[Future[None]] = set()
        self._sources: dict[bytes, Source] = {}
        self._leases = Leases(host, self._sources, self.matched, self._liveliness_changed)
        self._gaps = self._jumps = 0
        """Messages that are missing, and those that came right after them."""
        self._losses = Losses(host, name, self._label, qos.depth)
        self._deadline: SilenceTimer | None = None
        self._echo: Echo | None = None
        self._rings: RingReading | None = None
        self._wake: Callable[[], None] = _nothing
        """The function that an arrival calls while the subscription is not paused."""

    @property
    def handler_title(self) -> str:
        return title_of("subscription", self._label)

    @property
    def calls(self) -> tuple[object, ...]:
        return self._callback, self.name

    def _hint(self, name: str) -> str:
        if name in {field.name for field in self.type.SCHEMA.fields}:
            return f"it is no message: keep one in a method with @subscription, and read self.latest.{name}"
        return "keep it in a method with @subscription, as self.latest = message" if name in _NEWEST else ""

    def _open(self, key: str) -> None:
        context = self.host.context
        self.opened_ns = context.clock.time_ns()
        self._read = context.session.read
        if self._callback is None:
            self._inbox = self._new_inbox()
        else:
            self._inbox = open_inbox(self.qos, context.session.bell, _nothing)
            tell = (self._invoker(), self._finished, self.host.full_name)
            spec = RunnerSpec(
                self._label,
                *tell,
                "subscription",
                self._refused,
                lambda: self.dropped,
                wants_results=False,
                begins_outside=iscoroutinefunction(self._callback),
            )
            self.runner = self.host.runner(spec, self._inbox.items, self._group)
            self._inbox.ready = self.runner.wake
        self._inbox.tell_losses(self._warn_of_losses, 1 if isinstance(self._inbox, DeepInbox) else MANY_LOSSES)
        if self.qos.deadline_ns != INFINITE_NS:
            self._watch_deadline(self._inbox)
        # Publishers of this process deliver by `hand`, unless `ignore_local` excludes them.
        ignore_local = self._ignore_local or self.qos.durability is Durability.VOLATILE
        is_large = self.qos.durability is Durability.VOLATILE and registry.has_number_lists(self.type_name)
        options = {"ignore_local": ignore_local, "in_order": self.in_order or is_large}
        self._declared.append(context.session.open_receiver(key, self.qos, self._inbox, **options))
        if is_large:
            self._rings = context.readers.read(self._announced(), self._inbox)
            self._declared += () if self._rings is None else (self._rings,)
        if not self._ignore_local:
            context.intra_process.join(key, self)

    def _new_inbox(self) -> Inbox:
        """Return the queue for messages to be iterated."""
        return open_inbox(self.qos, self.host.context.session.bell, self._arrived)

    def hand(self, handed: Handed) -> None:
        """Receive a message of a publisher of this process."""
        if self._inbox is not None:
            self._inbox.put(handed)

    def _watch_deadline(self, inbox: Inbox) -> None:
        """Count a missed deadline for every period without a message, while there is a publisher."""
        timer = SilenceTimer(self.host.clock, self.qos.deadline_ns, lambda: self._tell("deadline_missed"))
        ready = inbox.ready

        def heard() -> None:
            timer.touch()
            ready()

        inbox.ready, self._deadline = heard, timer

    @property
    def received(self) -> int:
        """Messages that arrived since the start."""
        if self._inbox is None:
            return 0
        taken = self._taken if self.runner is None else self.runner.runs
        return taken + len(self._inbox.items) + self._inbox.dropped

    @property
    def dropped(self) -> int:
        """Messages lost to a full queue (`qos.depth`)."""
        return self._inbox.dropped if self._inbox is not None else 0

    @property
    def expired(self) -> int:
        """Messages dropped because they exceeded the publisher's lifespan or the subscription's."""
        return self._expiry.count

    @property
    def lost(self) -> int:
        """Messages that never arrived, by gaps in the publishers' sequence numbers."""
        return self.event_total("message_lost")

    def statistics(self) -> dict[str, Any]:
        """Return counters of messages (received, waiting, dropped, malformed, expired) and of callback runs."""
        waiting = 0 if self._inbox is None else len(self._inbox.items)
        counts = {"received": self.received, "waiting": waiting, "dropped": self.dropped}
        counts |= {"malformed": self.malformed, "expired": self.expired}
        if self.runner is not None:
            counts |= {"runs": self.runner.runs, "errors": self.runner.errors}
        return {**counts, **super().statistics()}

    def clock_changed(self) -> None:
        leases = [source.lease for source in self._sources.values()]
        for timer in (self._deadline, *leases):
            if timer is not None:
                timer.move(self.host.clock)

    def get_publisher_count(self) -> int:
        """Return the number of matched publishers."""
        self._announced()
        return len(self.matched)

    # publishers

    def _matched(self, other: Entity, alive: bool) -> None:
        if not alive:
            source = self._sources.pop(other.gid, None)
            was_alive = source is None or source.lease is None or source.lease.is_running
            end_lease(source)
            if self._rings is not None:
                self._rings.forget_ended()
        else:
            was_alive = False
            source = self._sources.setdefault(other.gid, Source(INFINITE_NS))
            source.expects(min(other.qos.lifespan_ns, self.qos.lifespan_ns))
            if other.qos.liveliness is Liveliness.MANUAL_BY_TOPIC and other.qos.lease_ns != INFINITE_NS:
                assert self._inbox is not None
                self._leases.watch(other, source, self._inbox)
        if self._deadline is not None:
            self._deadline.start() if self.matched else self._deadline.stop()
        if alive:
            self.host.context.unlatched.matched(self, other, self.host.log)
            check_ignored(self, self.host, is_ignoring=self._ignore_local)
        if alive or was_alive:
            self._leases.changed(1 if alive else -1, other.node_name)
        self._follow_echo()

    def _follow_echo(self) -> None:
        """Watch for a feedback loop while the node has a publisher of the topic itself."""
        own = self._announced()
        has_own = any((e.zid, e.nid) == (own.zid, own.nid) for e in self.matched.values())
        if self._echo is None and has_own and not self._ignore_local:
            self._echo = echo_of(self.host, self.name, lambda: self.received)
        if self._echo is not None:
            self._echo.follow(has_own=has_own)

    def _liveliness_changed(self, change: int, current: int, node: str) -> None:
        self._tell("liveliness_changed", change=change, current=current, detail=node)

    # messages

    def _take(self, arrival: Any) -> tuple[M, tuple[int, int, bytes]] | None:
        """Return a message and the fields of its `MessageInfo`; None if it is expired or malformed."""
        if arrival.__class__ is Handed:
            if self._is_fresh(*arrival.fields):
                return arrival.take(), arrival.fields
            self._expire(*arrival.fields)
            return None
        payload, beside = self._read(arrival)
        try:
            fields = attachment.fields(beside or b"")
        except DecodeError:  # accept peers whose attachment is missing or has another layout
            fields = _NO_INFO
        else:
            if not self._is_fresh(*fields):
                self._expire(*fields)
                return None
        try:
            return self._codec.decode(payload), fields
        except DecodeError as error:
            self.count_malformed(error)
            return None

    def _is_fresh(self, sequence: int, source_ns: int, gid: bytes) -> bool:
        """Record a message's sequence number and time; returns False if it has exceeded its lifespan."""
        source = self._sources.get(gid)
        if source is None:
            if len(self._sources) >= SOURCES_BOUND:  # forged senders must not exhaust the memory
                return True
            source = self._sources[gid] = Source(self.qos.lifespan_ns)
        missing = sequence - source.sequence - 1
        if missing > 0 and source.sequence:
            self._count_missing(missing)
        source.sequence = sequence
        if source.lease is not None:
            self._leases.revive(gid)
        if source.lifespan_ns == INFINITE_NS:
            return True
        return self.host.context.clock.time_ns() - source_ns <= source.lifespan_ns

    def _expire(self, _: int, source_ns: int, gid: bytes) -> None:
        taken = self._taken if self.runner is None else self.runner.runs
        lifespan_ns = self._sources[gid].lifespan_ns
        self._expiry.add(taken, lifespan_ns, self.host.context.clock.time_ns() - source_ns - lifespan_ns)

    def _count_missing(self, missing: int) -> None:
        """Count messages lost in transit, excluding those that the full queue dropped: both leave gaps."""
        self._gaps += missing
        self._jumps += 1
        dropped = self.dropped
        self._warn_of_losses()
        lost = self._gaps - dropped - self.lost
        if lost > 0:
            self._tell("message_lost", lost)

    def _warn_of_losses(self) -> None:
        """Warn once that a deep queue overflowed, or that most messages are lost."""
        is_unread = self._callback is None and not (self._taken or self._waiters)
        is_busy = self.runner is not None and bool(self.runner.active)
        deep = self._inbox.items.maxlen if isinstance(self._inbox, DeepInbox) else None
        gaps = None if self._callback is not None else self._jumps
        self._losses.warn(self.dropped, self.received, deep, is_unread=is_unread, is_busy=is_busy, gaps=gaps)

    def _invoker(self) -> Callable[[Any], Any]:
        """Return `_invoke`, with a fast path for the next message of a known publisher.

        All other arrivals take the general path.
        """
        general, callback, takes_info = self._invoke, self._callback, self._takes_info
        read, decode, sources = self._read, self._codec.decode, self._sources
        unpack, new = attachment.LAYOUT.unpack, tuple.__new__
        assert callback is not None

        def invoke(arrival: Any) -> Any:
            if arrival.__class__ is Handed:
                return general(arrival)
            payload, beside = read(arrival)
            try:
                sequence, source_ns, size, gid = unpack(beside or b"")
                source = sources[gid]
            except (struct.error, KeyError):
                return general(arrival)
            if size != 16 or sequence != source.sequence + 1 or source.needs_care:
                return general(arrival)
            source.sequence = sequence
            try:
                message = decode(payload)
            except DecodeError as error:
                self.count_malformed(error)
                return None
            return callback(message, new(MessageInfo, (sequence, source_ns, gid))) if takes_info else callback(message)

        return invoke

    def _invoke(self, arrival: Any) -> Any:
        taken = self._take(arrival)
        if taken is None:
            return None
        message, fields = taken
        assert self._callback is not None
        return self._callback(message, MessageInfo._make(fields)) if self._takes_info else self._callback(message)

    def _finished(self, arrival: Any, result: Any, error: BaseException | None) -> None:
        if error is not None:
            self.host.handler_failed(self._label, error, self._on_error)

    def _refused(self, arrival: Any) -> None:
        assert self._inbox is not None
        self._inbox.dropped += 1

    # iteration

    def _arrived(self) -> None:
        for waiter in self._waiters:
            if not waiter.done():
                waiter.set_result(None)

    def __aiter__(self) -> AsyncIterator[M]:
        if self._callback is not None:
            raise ClosedError(f"{self.name}: this subscription has a callback; make another one to iterate over")
        if self._reading is None:
            self._reading = SharedReading(self.host, self.name, self._waiters)
        self._reading.begins()
        return self

    async def __anext__(self) -> M:
        return (await self.next_with_info())[0]

    async def next_with_info(self) -> tuple[M, MessageInfo]:
        """Return the next message and its `MessageInfo`. Raises StopAsyncIteration when the subscription is closed."""
        while True:
            if self._inbox is None or self.entity is None:
                raise StopAsyncIteration(f"{self.name} is closed: read it while its node runs")
            while self._inbox.items:
                if monotonic() >= self._turn_ends:
                    await asyncio.sleep(0)  # a sender faster than the reader must not monopolize the loop
                    self._turn_ends = monotonic() + SLICE
                    if not self._inbox.items:
                        break
                self._taken += 1
                taken = self._take(self._inbox.items.popleft())
                if taken is not None:
                    message, fields = taken
                    return message, MessageInfo._make(fields)
            waiter: Future[None] = self.host.context.loop.create_future()
            self._waiters.add(waiter)
            try:
                await waiter
            finally:
                self._waiters.discard(waiter)
            self._turn_ends = monotonic() + SLICE

    def begin_to_stop(self) -> Runner | None:
        return self.runner

    def pause(self, why: str) -> Runner | None:
        """Drop arrivals until `resume`."""
        if self._inbox is not None and not self.idle_because:
            self._wake, self._inbox.ready = self._inbox.ready, self._leave_out
            self._leave_out()
        super().pause(why)
        return self.runner

    def resume(self) -> Runner | None:
        if self._inbox is not None and self.idle_because:
            self._leave_out()
            self._inbox.ready = self._wake
        super().resume()
        if self.runner is not None:
            self.runner.reopen()
        return self.runner

    def _leave_out(self) -> None:
        assert self._inbox is not None
        self._inbox.items.clear()
        if self._deadline is not None:
            self._deadline.touch()  # the publisher has met the deadline

    def close(self) -> None:
        if self.runner is not None:
            self.runner.cancel()
        if self.entity is not None:
            self.host.context.intra_process.leave(self.entity.data_key, self)
            self.host.context.unlatched.forget(self)
        if self._deadline is not None:
            self._deadline.stop()
        if self._echo is not None:
            self._echo.stop()
        if self._reading is not None:
            self._reading.stop()
        for source in self._sources.values():
            end_lease(source)
        self._sources.clear()
        super().close()
        self._arrived()


def unreadable(arrival: Any) -> tuple[bytes, bytes | None]:
    raise ClosedError(f"{arrival!r} arrived before the subscription was open")


def _nothing() -> None:
    """Do nothing: no reader is waiting."""
