"""Publishers, subscriptions, services, clients and timers at work: what `create_*` returns."""

from __future__ import annotations

from asyncio import CancelledError, Future
from collections import deque
from collections.abc import AsyncIterator, Callable
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from graphflow.errors import (
    CallTimeout,
    ClosedError,
    DecodeError,
    EncodeError,
    RemoteError,
    ServerLost,
    ServiceUnavailable,
)
from graphflow.machines.group import GroupState
from graphflow.msgs import registry
from graphflow.msgs.base import Message, Request, Response, Service
from graphflow.names import did_you_mean
from graphflow.qos import History, Qos
from graphflow.runtime.clock import period_ns
from graphflow.runtime.scheduler import Runner
from graphflow.times import to_ns
from graphflow.transport.base import Answer, Caller, Closable, Inbox, Sender
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity, Kind

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

M = TypeVar("M", bound=Message)

KEEP_ALL_BOUND = 10_000
"""Messages a KEEP_ALL subscription holds before it counts losses."""
REQUEST_QUEUE = 1_000
"""Requests a service holds."""
DISCOVERY_GRACE = 1.0
"""Seconds a call waits for a server that nobody has announced yet."""


class Endpoint:
    """What a node holds on the network under one name, from `open` to `close`."""

    kind: Kind

    def __init__(self, node: Node, type_name: str, name: str, qos: Qos) -> None:
        self.node = node
        self.type_name = type_name
        self.name = name
        """The full, remapped name."""
        self.qos = qos
        self.entity: Entity | None = None
        """How the endpoint is announced; None until the node runs."""
        self._declared: list[Closable] = []

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name} [{self.type_name}]>"

    @property
    def is_open(self) -> bool:
        return self.entity is not None

    def open(self) -> None:
        """Declare it on the network and announce it. Done by the node."""
        context, node = self.node.context, self.node
        self.entity = Entity(
            context.domain,
            context.session.zid,
            node.id,
            context.next_id(),
            self.kind,
            node.namespace,
            node.name,
            self.name,
            self.type_name,
            registry.hash_of(self.type_name),
            self.qos,
        )
        self._open(self.entity.data_key)
        # After the declaration, so that whoever sees the token can reach what it announces.
        self._declared.append(context.session.announce(self.entity.token))

    def _open(self, key: str) -> None:
        raise NotImplementedError

    def close(self) -> None:
        """Withdraw it from the network. Closing twice is harmless."""
        declared, self._declared = self._declared, []
        for closable in reversed(declared):
            closable.close()
        self.entity = None
        self.node.forget(self)

    def _announced(self) -> Entity:
        if self.entity is None:
            raise ClosedError(
                f"{self.name}: node {self.node.full_name} is not running; use this from its handlers and tasks"
            )
        return self.entity


class TopicPublisher(Endpoint, Generic[M]):
    """A publisher at work."""

    kind = Kind.PUBLISHER

    def __init__(self, node: Node, type_: type[M], name: str, qos: Qos) -> None:
        super().__init__(node, type_.SCHEMA.name, name, qos)
        self.type = type_
        self.published = 0
        """Messages sent since the start; also the last sequence number."""
        self._encode = registry.codec(self.type_name).encode
        self._put: Callable[[bytes, bytes], None] = self._not_open

    def _open(self, key: str) -> None:
        sender: Sender = self.node.context.session.open_sender(key, self.qos)
        self._declared.append(sender)
        self._put = sender.put

    def publish(self, message: M) -> None:
        """Send a message. Never waits: a subscriber that cannot keep up loses messages.

        Raises:
            EncodeError: A field does not fit its type, or the message is of another type.
            ClosedError: The node is not running.
        """
        if message.__class__ is not self.type:
            raise EncodeError(f"{self.name} carries {self.type_name}, not {message!r}")
        payload = self._encode(message)
        entity = self._announced()
        self.published += 1
        self._put(payload, attachment.pack(self.published, self.node.clock.time_ns(), entity.gid))

    def get_subscription_count(self) -> int:
        """Subscriptions in the graph that get these messages."""
        key = self._announced().data_key
        return sum(1 for e in self.node.context.cache.endpoints(Kind.SUBSCRIPTION, self.name) if e.data_key == key)

    def close(self) -> None:
        self._put = self._not_open
        super().close()

    def _not_open(self, payload: bytes, attachment_: bytes) -> None:
        self._announced()


class MessageInfo(NamedTuple):
    """What came beside a message."""

    sequence: int
    """Counts the sender's messages from 1; 0 when the sender did not say."""
    source_ns: int
    """When it was sent, nanoseconds since 1970 on the sender's clock."""
    gid: bytes
    """Which publisher sent it."""


class TopicSubscription(Endpoint, Generic[M]):
    """A subscription at work: with a callback, or to be iterated: `async for message in subscription`."""

    kind = Kind.SUBSCRIPTION

    def __init__(
        self,
        node: Node,
        type_: type[M],
        name: str,
        qos: Qos,
        callback: Callable[[M], Any] | None = None,
        label: str = "",
        group: GroupState[Runner] | None = None,
    ) -> None:
        super().__init__(node, type_.SCHEMA.name, name, qos)
        self.type = type_
        self.malformed = 0
        """Payloads that were no message of the type, and were dropped."""
        self._callback = callback
        self._label = label or f"subscription {name}"
        self._group = group
        self._decode = registry.codec(self.type_name).decode
        self.runner: Runner | None = None
        self._inbox: Inbox | None = None
        self._waiters: set[Future[None]] = set()

    def _open(self, key: str) -> None:
        context = self.node.context
        bound = KEEP_ALL_BOUND if self.qos.history is History.KEEP_ALL else self.qos.depth
        if self._callback is None:
            self._inbox = Inbox(context.session.bell, bound, self._arrived)
        else:
            self._inbox = Inbox(context.session.bell, bound, lambda: None)
            self.runner = self.node.runner(self._label, self._group, self._inbox.items, self._invoke, self._finished)
            self._inbox.ready = self.runner.wake
        self._declared.append(context.session.open_receiver(key, self.qos, self._inbox))

    @property
    def received(self) -> int:
        """Messages that arrived since the start."""
        return self._inbox.received if self._inbox is not None else 0

    @property
    def dropped(self) -> int:
        """Messages lost because the queue (`qos.depth`) was full."""
        return self._inbox.dropped if self._inbox is not None else 0

    def get_publisher_count(self) -> int:
        """Publishers in the graph whose messages arrive here."""
        key = self._announced().data_key
        return sum(1 for e in self.node.context.cache.endpoints(Kind.PUBLISHER, self.name) if e.data_key == key)

    def _invoke(self, arrival: Any) -> Any:
        assert self._callback is not None
        payload, _ = self.node.context.session.read(arrival)
        try:
            message = self._decode(payload)
        except DecodeError as error:
            self._count_malformed(error)
            return None
        return self._callback(message)

    def _finished(self, arrival: Any, result: Any, error: BaseException | None) -> None:
        if error is not None:
            self.node.handler_failed(self._label, error)

    def _count_malformed(self, error: DecodeError) -> None:
        self.malformed += 1
        if self.malformed == 1 or self.malformed % 1000 == 0:
            self.node.log.warning("%s: dropped a malformed message (%d so far): %s", self.name, self.malformed, error)

    # iteration

    def _arrived(self) -> None:
        for waiter in self._waiters:
            if not waiter.done():
                waiter.set_result(None)

    def __aiter__(self) -> AsyncIterator[M]:
        if self._callback is not None:
            raise ClosedError(f"{self.name}: this subscription has a callback; make another one to iterate over")
        return self

    async def __anext__(self) -> M:
        return (await self.next_with_info())[0]

    async def next_with_info(self) -> tuple[M, MessageInfo]:
        """The next message and what came beside it. Ends the iteration when the subscription is closed."""
        while True:
            if self._inbox is None or self.entity is None:
                raise StopAsyncIteration
            while self._inbox.items:
                payload, beside = self.node.context.session.read(self._inbox.items.popleft())
                try:
                    return self._decode(payload), _info(beside)
                except DecodeError as error:
                    self._count_malformed(error)
            waiter: Future[None] = self.node.context.loop.create_future()
            self._waiters.add(waiter)
            try:
                await waiter
            finally:
                self._waiters.discard(waiter)

    def close(self) -> None:
        if self.runner is not None:
            self.runner.cancel()
        super().close()
        self._arrived()


def _info(beside: bytes | None) -> MessageInfo:
    try:
        return MessageInfo(*attachment.unpack(beside or b""))
    except DecodeError:
        return MessageInfo(0, 0, bytes(16))


_STOPPING = RemoteError("Cancelled", "the server is stopping")
"""What a server that stops answers; no exception class is called that."""


class ServiceServer(Endpoint, Generic[Request, Response]):
    """A service at work."""

    kind = Kind.SERVICE

    def __init__(
        self,
        node: Node,
        type_: type[Service[Request, Response]],
        name: str,
        qos: Qos,
        callback: Callable[[Request], Any],
        label: str = "",
        group: GroupState[Runner] | None = None,
    ) -> None:
        super().__init__(node, type_.NAME, name, qos)
        self.type = type_
        self._callback = callback
        self._label = label or f"service {name}"
        self._group = group
        service = registry.service_schema(type_.NAME)
        self._decode = registry.codec(service.request.name).decode
        self._encode = registry.codec(service.response.name).encode
        self._response: type[Any] = registry.interface_class(service.response.name)
        self.runner: Runner | None = None
        self._inbox: Inbox | None = None

    def _open(self, key: str) -> None:
        session = self.node.context.session
        self._inbox = Inbox(session.bell, REQUEST_QUEUE, lambda: None)
        self.runner = self.node.runner(self._label, self._group, self._inbox.items, self._invoke, self._finished)
        self._inbox.ready = self.runner.wake
        self._declared.append(session.open_server(key, self._inbox))

    def _invoke(self, request: Any) -> Any:
        attachment.unpack(request.attachment or b"")
        return self._callback(self._decode(request.payload))

    def _finished(self, request: Any, result: Any, error: BaseException | None) -> None:
        if error is None:
            try:
                if result is None and not self._response.SCHEMA.fields:
                    result = self._response()
                if result.__class__ is not self._response:
                    raise TypeError(
                        f"the handler of {self.name} returned {result!r}, not {self._response.__qualname__}"
                    )
                payload = self._encode(result)
            except (TypeError, EncodeError) as wrong:
                error = wrong
        if error is not None:
            if isinstance(error, CancelledError) and self.runner is not None and self.runner.closed:
                request.reply_error(_STOPPING.to_payload())
                return
            if not isinstance(error, DecodeError):
                self.node.handler_failed(self._label, error)
            request.reply_error(RemoteError(type(error).__name__, str(error)).to_payload())
            return
        asked = attachment.unpack(request.attachment)
        now = self.node.clock.time_ns()
        request.reply(payload, attachment.pack(asked.sequence, now, asked.gid))

    def close(self) -> None:
        if self.runner is not None:
            self.runner.cancel()
        while self._inbox is not None and self._inbox.items:
            self._inbox.items.popleft().reply_error(_STOPPING.to_payload())
        super().close()


class ServiceClient(Endpoint, Generic[Request, Response]):
    """A client at work."""

    kind = Kind.CLIENT

    def __init__(self, node: Node, type_: type[Service[Request, Response]], name: str, qos: Qos) -> None:
        super().__init__(node, type_.NAME, name, qos)
        self.type = type_
        service = registry.service_schema(type_.NAME)
        self._request: type[Any] = registry.interface_class(service.request.name)
        self._encode = registry.codec(service.request.name).encode
        self._decode = registry.codec(service.response.name).decode
        self._sequence = 0
        self._caller: Caller | None = None

    def _open(self, key: str) -> None:
        self._caller = self.node.context.session.open_caller(key)
        self._declared.append(self._caller)

    def service_is_ready(self) -> bool:
        """Whether a server of this name and type is in the graph and can be reached."""
        return self._server_announced() and self._caller is not None and self._caller.has_server()

    def _server_announced(self) -> bool:
        key = self._announced().data_key
        return any(e.data_key == key for e in self.node.context.cache.endpoints(Kind.SERVICE, self.name))

    async def wait_ready(self, timeout: float | None = None) -> None:
        """Wait until there is a server.

        Args:
            timeout: Seconds; None for as long as it takes.

        Raises:
            ServiceUnavailable: None came in time.
        """
        wait = self.node.context.wait_for(self._server_announced)
        if timeout is None:
            await wait
            return
        try:
            async with self.node.clock.timeout(timeout):
                await wait
        except TimeoutError:
            raise ServiceUnavailable(self._nobody()) from None

    def _nobody(self) -> str:
        services = self.node.context.cache.services()
        if self.name in services:
            offered = [e.type for e in self.node.context.cache.endpoints(Kind.SERVICE, self.name)]
            if offered and self.type_name not in offered:
                return f"service {self.name} is a {offered[0]}, not a {self.type_name}"
        offers = {e.name for e in self.node.context.cache.endpoints(Kind.SERVICE)}
        return f"nobody offers the service {self.name} [{self.type_name}]{did_you_mean(self.name, offers)}"

    async def call(self, request: Request, *, timeout: float | None = 10.0) -> Response:
        """Ask, and wait for the response.

        Args:
            request: An instance of the service's `Request`.
            timeout: Seconds until the call gives up; None waits for ever.

        Raises:
            ServiceUnavailable: There is no server, and none came within `DISCOVERY_GRACE`.
            ServerLost: The server stopped or went away while the call waited.
            CallTimeout: The deadline passed.
            RemoteError: The handler raised.
            EncodeError: The request does not fit its type.
            DecodeError: The response is malformed.
        """
        if request.__class__ is not self._request:
            raise EncodeError(f"{self.name} takes {self._request.__qualname__}, not {request!r}")
        payload = self._encode(request)
        started = self.node.clock.monotonic_ns()
        if not self._server_announced():
            await self.wait_ready(DISCOVERY_GRACE if timeout is None else min(timeout, DISCOVERY_GRACE))
        answer = await self._ask(payload, None if timeout is None else started + to_ns(timeout), timeout)
        message: Response = self._decode(answer.payload)
        return message

    async def _ask(self, payload: bytes, deadline_ns: int | None, timeout: float | None) -> Answer:
        entity, caller = self._announced(), self._caller
        assert caller is not None
        self._sequence += 1
        sequence = self._sequence
        future: Future[Answer] = self.node.context.loop.create_future()

        def answered(answer: Answer | None) -> None:
            if future.done():
                return
            if answer is None:
                future.set_exception(ServerLost(f"the server of {self.name} went away before it answered"))
            elif answer.is_error:
                error = RemoteError.from_payload(answer.payload, self.name)
                lost = ServerLost(f"the server of {self.name} stopped before it answered")
                future.set_exception(lost if error.type == _STOPPING.type else error)
            elif _sequence_of(answer) == sequence:
                future.set_result(answer)

        def expired() -> None:
            if not future.done():
                future.set_exception(CallTimeout(f"{self.name} did not answer within {timeout:g} s"))

        beside = attachment.pack(sequence, self.node.clock.time_ns(), entity.gid)
        give_up = caller.call(payload, beside, answered)
        alarm = None if deadline_ns is None else self.node.clock.call_at(deadline_ns, expired)
        try:
            return await future
        except (CallTimeout, CancelledError):
            give_up()
            raise
        finally:
            if alarm is not None:
                alarm.cancel()


def _sequence_of(answer: Answer) -> int | None:
    try:
        return attachment.unpack(answer.attachment or b"").sequence
    except DecodeError:
        return None


class TimerInfo(NamedTuple):
    """When a timer's run was due and when it began, in nanoseconds of the clock, and how many runs were missed."""

    expected_ns: int
    actual_ns: int
    skipped: int


class Timer:
    """A timer at work: skips missed periods, keeps phase, and has one run at a time.

    Source: rcl timer.c.
    """

    def __init__(
        self,
        node: Node,
        period_ns: int,
        callback: Callable[[TimerInfo], Any],
        label: str,
        group: GroupState[Runner] | None = None,
    ) -> None:
        self.node = node
        self.skipped = 0
        """Periods missed since the start, because a run or its wait for a slot took too long."""
        self._period_ns = period_ns
        self._label = label
        self._callback = callback
        self._group = group
        self._next_ns = 0
        self._handle: Any = None
        self._due: deque[TimerInfo] = deque()
        self.runner: Runner | None = None
        self._missed = 0

    def __repr__(self) -> str:
        return f"<Timer {self._label} {self._period_ns / 1e9:g} s>"

    @property
    def period(self) -> float:
        """Seconds between runs. Setting it re-arms the timer, one new period from now.

        Raises:
            ValueError: It is set to something that is not a positive number.
        """
        return self._period_ns / 1e9

    @period.setter
    def period(self, seconds: float) -> None:
        self._period_ns = period_ns(seconds, None)
        if self.runner is not None:
            self.reset()

    def open(self) -> None:
        """Start. Done by the node."""
        self.runner = self.node.runner(self._label, self._group, self._due, self._callback, self._finished)
        self.reset()

    def reset(self) -> None:
        """Begin anew: the next run is one period from now."""
        self._arm(self.node.clock.monotonic_ns() + self._period_ns)

    def _arm(self, when_ns: int) -> None:
        if self._handle is not None:
            self._handle.cancel()
        self._next_ns = when_ns
        self._handle = self.node.clock.call_at(when_ns, self._fire)

    def _fire(self) -> None:
        assert self.runner is not None
        now, due = self.node.clock.monotonic_ns(), self._next_ns
        late = max(0, (now - due) // self._period_ns)
        self._arm(due + (1 + late) * self._period_ns)
        self.skipped += late
        self._missed += late
        if self._due or self.runner.active:
            self.skipped += 1
            self._missed += 1
            return
        self._due.append(TimerInfo(due, now, self._missed))
        self._missed = 0
        self.runner.wake()

    def _finished(self, info: TimerInfo, result: Any, error: BaseException | None) -> None:
        if error is not None:
            self.node.handler_failed(self._label, error)

    def cancel(self) -> None:
        """Stop the timer; `reset` starts it again."""
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None

    def close(self) -> None:
        """Stop for good, and cancel a run under way."""
        self.cancel()
        if self.runner is not None:
            self.runner.cancel()
        self.node.forget(self)
