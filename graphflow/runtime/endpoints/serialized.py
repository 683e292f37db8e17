"""Endpoints of serialized messages, whose type's definition need not be known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from graphflow.errors import DecodeError
from graphflow.msgs import registry
from graphflow.qos import Durability, Qos
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.events import OnEvent
from graphflow.runtime.endpoints.intra_process import Handed, Receiver
from graphflow.runtime.endpoints.shared_memory import RingReading
from graphflow.runtime.endpoints.subscriptions import unreadable
from graphflow.runtime.part import Host
from graphflow.transport.base import Sender
from graphflow.transport.inbox import Inbox, open_inbox
from graphflow.wire import attachment
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Entity, Kind

AT_ONCE = 64
"""Messages delivered per iteration of the event loop."""
UNKNOWN = MessageInfo(0, 0, bytes(16))
"""The `MessageInfo` of a message without a readable attachment."""

Callback = Callable[[bytes, MessageInfo], object]
"""Takes a serialized message (CDR, with its 4-byte header) and its `MessageInfo`."""


class RawSubscription(Endpoint):
    """A subscription that delivers serialized messages. Made by `raw.subscribe`."""

    kind = Kind.SUBSCRIPTION

    def __init__(
        self,
        host: Host,
        type_name: str,
        name: str,
        qos: Qos,
        callback: Callback,
        type_hash: str = "",
        on_event: OnEvent | None = None,
    ) -> None:
        super().__init__(host, type_name, name, qos, on_event, type_hash)
        self.received = 0
        """Messages delivered."""
        self._callback = callback
        self._inbox: Inbox | None = None
        self._read: Callable[[Any], tuple[bytes, bytes | None]] = unreadable
        self._rings: RingReading | None = None

    @property
    def type_hash(self) -> str:
        """The type's RIHS01 hash."""
        return self._type_hash or registry.hash_of(self.type_name)

    @property
    def dropped(self) -> int:
        """Messages lost to a full queue (`qos.depth`)."""
        return self._inbox.dropped if self._inbox is not None else 0

    def _open(self, key: str) -> None:
        context = self.host.context
        self._read = context.session.read
        self._inbox = open_inbox(self.qos, context.session.bell, self._arrived)
        # Publishers of this process deliver by `hand`, as to other subscriptions.
        is_volatile = self.qos.durability is Durability.VOLATILE
        options = {"ignore_local": is_volatile, "in_order": is_volatile}
        self._declared.append(context.session.open_receiver(key, self.qos, self._inbox, **options))
        if is_volatile:
            self._rings = context.readers.read(self._announced(), self._inbox)
            self._declared += () if self._rings is None else (self._rings,)
        context.intra_process.join(key, self)

    def _matched(self, other: Entity, alive: bool) -> None:
        if self._rings is not None and not alive:
            self._rings.forget_ended()

    def hand(self, handed: Handed) -> None:
        """Receive a message of a publisher of this process."""
        if self._inbox is not None:
            self._inbox.put(handed)

    def _arrived(self) -> None:
        inbox = self._inbox
        if inbox is None or self.entity is None:
            return
        items = inbox.items
        for _ in range(min(AT_ONCE, len(items))):
            arrival = items.popleft()
            self.received += 1
            if arrival.__class__ is Handed:
                self._callback(arrival.take().to_bytes(), MessageInfo._make(arrival.fields))
                continue
            payload, beside = self._read(arrival)
            try:
                info = MessageInfo._make(attachment.fields(beside or b""))
            except DecodeError:  # accept peers whose attachment is missing or has another layout
                info = UNKNOWN
            self._callback(bytes(payload), info)
        if items:
            self.host.context.loop.call_soon(self._arrived)

    def statistics(self) -> dict[str, object]:
        return {"received": self.received, "dropped": self.dropped, **super().statistics()}

    def close(self) -> None:
        if self.entity is not None:
            self.host.context.intra_process.leave(self.entity.data_key, self)
        super().close()


class RawPublisher(Endpoint):
    """A publisher of serialized messages. Made by `raw.advertise`."""

    kind = Kind.PUBLISHER

    def __init__(
        self,
        host: Host,
        type_name: str,
        name: str,
        qos: Qos,
        type_hash: str = "",
        on_event: OnEvent | None = None,
    ) -> None:
        super().__init__(host, type_name, name, qos, on_event, type_hash)
        self.published = 0
        """Messages sent since the start, which is also the last sequence number."""
        self._sender: Sender | None = None
        self._here: Sequence[Receiver] = ()

    def _open(self, key: str) -> None:
        self._sender = self.host.context.session.open_sender(key, self.qos, only_others=True)
        self._declared.append(self._sender)
        self._here = self.host.context.intra_process.receivers(key, self.qos.durability)

    def publish(self, payload: bytes) -> None:
        """Send a serialized message. Never waits.

        Args:
            payload: CDR with its 4-byte header. It is checked only if subscriptions of this process receive it.

        Raises:
            DecodeError: Subscriptions of this process would receive it, and it is not a message of the type.
            ClosedError: The node is not running.
        """
        fields = (self.published + 1, self.host.context.clock.time_ns(), self._announced().gid)
        if self._here:
            codec, receivers = registry.codec(self.type_name), tuple(self._here)
            handed = Handed(codec.decode(payload), fields, len(receivers), codec.clone)
            for receiver in receivers:
                receiver.hand(handed)
        self.published += 1
        if self._sender is not None and self._sender.is_wanted:
            self._sender.put(payload, attachment=attachment.pack(*fields))

    def statistics(self) -> dict[str, object]:
        return {"published": self.published, **super().statistics()}

    def close(self) -> None:
        self._sender, self._here = None, ()
        super().close()
