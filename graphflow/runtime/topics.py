"""Publishers and subscriptions at work."""

from __future__ import annotations

import asyncio
from asyncio import Future
from collections.abc import AsyncIterator, Callable
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from graphflow.errors import ClosedError, DecodeError, EncodeError
from graphflow.machines.group import GroupState
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.qos import History, Qos
from graphflow.runtime.endpoints import Endpoint
from graphflow.runtime.scheduler import BURST, Runner
from graphflow.transport.base import Inbox, Sender
from graphflow.wire import attachment
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

M = TypeVar("M", bound=Message)

KEEP_ALL_BOUND = 10_000
"""Messages a KEEP_ALL subscription holds before it counts losses."""


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
        self._taken = 0
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
                self._taken += 1
                if self._taken % BURST == 0:
                    await asyncio.sleep(0)  # a sender that is faster than the reader must not hold the loop
                    if not self._inbox.items:
                        break
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
