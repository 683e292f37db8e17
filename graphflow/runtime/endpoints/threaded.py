"""Endpoints for threads: any thread may send, and arrivals queue until a thread takes them.

Messages are CDR with the 4-byte header, since rclpy has its own message classes. Arrivals bypass the loop and ring the
bell passed to the endpoint, so that there is one thread switch between the network and the handler. Opening and closing
happen on the loop, as for all endpoints.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

from graphflow.errors import CallError, ClosedError, DecodeError, ServerLost
from graphflow.machines.waits.wait_graph import call_id
from graphflow.msgs import registry
from graphflow.qos import DEFAULT, Qos
from graphflow.runtime.endpoints.direct_calls import unanswered, warn_of_refused
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.events import OnEvent, QosEventKind
from graphflow.runtime.endpoints.intra_process import Handed
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.endpoints.service_client import error_of, sequence_of
from graphflow.runtime.endpoints.service_events import Introspection, ServiceEvent, ServiceEvents
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.part import Host
from graphflow.transport.base import Answer, Caller, Request, request_size
from graphflow.transport.inbox import REQUESTS_BOUND, Inbox, RequestInbox, Wakeup, open_inbox
from graphflow.wire import attachment
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Kind


class ThreadedPublisher(TopicPublisher[Any]):
    """A publisher of serialized messages, for any thread."""

    def _check_first(self) -> None:
        """Check nothing: rclpy's publisher checks the messages before it serializes them."""

    def put(self, payload: bytes) -> None:
        """Send a message. Never waits.

        Raises:
            DecodeError: Subscriptions of this process would receive it, and it is not a message of the type.
            ClosedError: The node is not running.
        """
        with self._order.lock:
            sender, here = self._sender, tuple(self._here)
            if not (here or sender.is_wanted):
                self._announced()
                self.unheard += 1
            handed = self._codec.decode(payload) if here else None
            self._order.number += 1
            fields = (self.published, self._now_ns(), self._gid)
            if here:
                message = Handed(handed, fields, len(here), self._codec.clone)
                for receiver in here:
                    receiver.hand(message)
            if sender.is_wanted:
                try:
                    sender.put(payload, attachment=attachment.pack(*fields))
                except Exception as error:  # any, since the node may stop on another thread: see `_not_sent`
                    raise self._not_sent(error) from None
        for timer in (self._deadline, self._lease):
            if timer is not None:
                timer.touch()


class Taken(NamedTuple):
    """A message taken from a subscription."""

    payload: bytes
    info: MessageInfo


class ThreadedSubscription(TopicSubscription[Any]):
    """A subscription whose messages threads take.

    Args:
        bell: Rung when a message has arrived.
        ready: Called by the thread that the bell wakes.
    """

    latched_profile = "QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)"
    sensor_example = ", as in create_subscription({}, '{}', callback, qos_profile_sensor_data), from rclpy.qos"

    def __init__(
        self,
        host: Host,
        type_: Any,
        name: str,
        qos: Qos,
        bell: Wakeup,
        ready: Callable[[], None],
        on_event: OnEvent | None = None,
    ) -> None:
        super().__init__(host, type_, name, qos, on_event=on_event)
        self._codec = _AS_IT_IS
        self._bell, self._ready = bell, ready

    def _new_inbox(self) -> Inbox:
        return open_inbox(self.qos, self._bell, self._ready)

    @property
    def waiting(self) -> int:
        """Messages that have arrived and were not taken."""
        return 0 if self._inbox is None else len(self._inbox.items)

    def take(self) -> Taken | None:
        """Take the oldest message; None if there is none. Expired messages are skipped."""
        inbox = self._inbox
        while inbox is not None and self.entity is not None:
            try:
                arrival = inbox.items.popleft()
            except IndexError:
                return None
            self._taken += 1
            taken = self._take(arrival)
            if taken is not None:
                message, fields = taken
                payload = message if isinstance(message, bytes) else message.to_bytes()
                return Taken(payload, MessageInfo._make(fields))
        return None

    def _tell(
        self, kind: QosEventKind, more: int = 1, change: int | None = None, current: int = 0, detail: str = ""
    ) -> None:
        context = self.host.context
        if threading.get_ident() == context.ledger.thread:
            super()._tell(kind, more, change, current, detail)
        elif not context.loop.is_closed():
            context.loop.call_soon_threadsafe(super()._tell, kind, more, change, current, detail)


class _AsItIs:
    """The identity codec, for messages that stay serialized."""

    @staticmethod
    def decode(payload: bytes) -> bytes:
        return payload


_AS_IT_IS: Any = _AsItIs()


class Asked(NamedTuple):
    """A request taken from a service."""

    payload: bytes
    sequence: int
    gid: bytes
    source_ns: int
    request: Request

    @property
    def call(self) -> str:
        """The call's id in the wait-for graphs of all processes."""
        return call_id(self.gid, self.sequence)


class ThreadedService(Endpoint):
    """A service whose requests threads take and answer.

    Args:
        type_: A class with `NAME`; its `Event` is a message class of graphflow's.
        bell: Rung when a request has arrived.
        ready: Called by the thread that the bell wakes.
    """

    kind = Kind.SERVICE

    def __init__(self, host: Host, type_: Any, name: str, qos: Qos, bell: Wakeup, ready: Callable[[], None]) -> None:
        super().__init__(host, type_.NAME, name, qos)
        self.inbox = RequestInbox(bell, REQUESTS_BOUND, ready, request_size, unanswered)
        self.inbox.tell_losses(lambda: warn_of_refused(self.inbox, f"{name} of {host.full_name}: requests"), 1)
        self._service_events = ServiceEvents(host, type_, name)

    def configure_introspection(self, level: Introspection, qos: Qos = DEFAULT) -> None:
        """Publish service events as `ServiceServer.configure_introspection` does."""
        self._service_events.configure(level, qos, is_open=self.is_open)

    def _open(self, key: str) -> None:
        self._declared.append(self.host.context.session.open_server(key, self.inbox))
        self._service_events.open()

    def take(self) -> Asked | None:
        """Take the oldest request; None if there is none."""
        while True:
            try:
                request = self.inbox.items.popleft()
            except IndexError:
                return None
            asked = read_request(request)
            if asked is not None:
                return asked

    def answer(self, asked: Asked, payload: bytes) -> None:
        """Send the response to a request, once."""
        now_ns = self.host.context.clock.time_ns()
        asked.request.reply(payload, attachment.pack(asked.sequence, now_ns, asked.gid))

    def tell(self, event: ServiceEvent, asked: Asked, payload: bytes) -> None:
        """Publish an event of a call with its request or response, if introspection is on."""
        if self._service_events.is_on:
            tell_event(self.host, self._service_events, event, (asked.gid, asked.sequence), self.type_name, payload)

    def close(self) -> None:
        self._service_events.close()
        super().close()


def tell_event(
    host: Host, events: ServiceEvents, event: ServiceEvent, call: tuple[bytes, int], service: str, payload: bytes
) -> None:
    """Publish an event of a call, from any thread.

    Args:
        call: The client's GID and the call's sequence number.
        payload: The request or response as CDR.
    """
    schema = registry.service_schema(service)
    is_request = event in (ServiceEvent.REQUEST_SENT, ServiceEvent.REQUEST_RECEIVED)
    part = schema.request if is_request else schema.response
    message = registry.codec(part.name).decode(payload)
    told = {"request" if is_request else "response": message}
    host.context.loop.call_soon_threadsafe(lambda: events.tell(event, *call, **told))


def read_request(request: Request) -> Asked | None:
    """Read an arrived request; None if its attachment does not identify the client."""
    try:
        sequence, source_ns, gid = attachment.fields((request.attachment or b"")[: attachment.SIZE])
    except DecodeError:
        return None
    return Asked(request.payload, sequence, gid, source_ns, request)


class Answered(NamedTuple):
    """The outcome of a call."""

    sequence: int
    payload: bytes = b""
    error: CallError | None = None


class ThreadedClient(Endpoint):
    """A client whose calls and responses threads handle.

    Args:
        type_: As for `ThreadedService`.
        bell: Rung when a response has arrived.
        ready: Called by the thread that the bell wakes.
        changed: Called on the loop when servers have come or gone.
    """

    kind = Kind.CLIENT

    def __init__(
        self,
        host: Host,
        type_: Any,
        name: str,
        qos: Qos,
        bell: Wakeup,
        ready: Callable[[], None],
        changed: Callable[[], None],
    ) -> None:
        super().__init__(host, type_.NAME, name, qos)
        self.inbox = Inbox(bell, None, ready)
        self._service_events = ServiceEvents(host, type_, name)
        self._caller: Caller | None = None
        self._changed = changed
        self.lost = 0
        """Calls whose server was missing or went away."""
        self.was_served = False
        """Whether a call was sent while there was a server."""
        self._sequence = 0
        self._lock = threading.Lock()

    def configure_introspection(self, level: Introspection, qos: Qos = DEFAULT) -> None:
        """Publish service events as `ServiceServer.configure_introspection` does."""
        self._service_events.configure(level, qos, is_open=self.is_open)

    def _open(self, key: str) -> None:
        self._caller = self.host.context.session.open_caller(key, self._changed)
        self._declared.append(self._caller)
        self._service_events.open()

    def _matched(self, other: Any, alive: bool) -> None:
        self._changed()

    @property
    def has_server(self) -> bool:
        """Whether there is a reachable server."""
        return bool(self.matched) and self._caller is not None and self._caller.has_server

    def send(self, payload: bytes) -> int:
        """Send a request; returns its sequence number, which identifies the response.

        Raises:
            ClosedError: The node is not running.
        """
        caller, gid = self._caller, self._announced().gid
        if caller is None:
            raise ClosedError(f"the client of {self.name} is closed")
        self.was_served = self.was_served or self.has_server
        with self._lock:
            self._sequence += 1
            sequence = self._sequence
        beside = attachment.pack(sequence, self.host.context.clock.time_ns(), gid)
        is_over = False

        def arrived(answer: Answer | None) -> None:
            nonlocal is_over
            is_over = is_over or self._arrived(sequence, answer)  # the end of the call follows its response

        caller.call(payload, beside, arrived)
        return sequence

    def call_id(self, sequence: int) -> str:
        """Return a call's id in the wait-for graphs of all processes."""
        return call_id(self._announced().gid, sequence)

    def _arrived(self, sequence: int, answer: Answer | None) -> bool:
        """Queue a response; returns whether its call was pending."""
        if answer is None:
            self.lost += 1
            self.inbox.put(Answered(sequence, error=ServerLost(f"the server of {self.name} did not answer")))
        elif answer.is_error:
            self.inbox.put(Answered(sequence, error=error_of(answer.payload, self.name)))
        elif sequence_of(answer) == sequence:
            self.inbox.put(Answered(sequence, answer.payload))
        else:
            return False
        return True

    def tell(self, event: ServiceEvent, sequence: int, payload: bytes) -> None:
        """Publish an event of a call as `ThreadedService.tell` does."""
        if self._service_events.is_on and self.entity is not None:
            call = (self.entity.gid, sequence)
            tell_event(self.host, self._service_events, event, call, self.type_name, payload)

    def take(self) -> Answered | None:
        """Take the oldest response; None if there is none."""
        try:
            answered: Answered = self.inbox.items.popleft()
        except IndexError:
            return None
        return answered

    def close(self) -> None:
        self._service_events.close()
        self._caller = None
        super().close()
