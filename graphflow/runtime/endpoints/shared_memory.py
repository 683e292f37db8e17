"""Shared-memory delivery: subscriptions in other processes that read large messages from the publisher's memory.

Such a subscription, of the same user on the same machine, is announced by a second token. A publisher uses shared
memory while all its subscriptions in other processes are of that kind, and sends ordinary messages otherwise: nodes of
ROS 2, of other machines and of other users cannot read it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from graphflow.qos import Durability, History
from graphflow.transport.base import Closable, RingReceiver, Session
from graphflow.transport.inbox import KEEP_ALL_BOUND, Inbox
from graphflow.wire.liveliness import Entity
from graphflow.wire.shared_memory import Reader, parse_reader, reader_token, readers_key, ring_key

READERS_BOUND = 10_000
"""Subscriptions tracked; the limit protects against arbitrary announcements."""


class RingReading:
    """A subscription's access to rings, until closed."""

    def __init__(self, receiver: RingReceiver, token: Closable) -> None:
        self._receiver, self._token = receiver, token

    def forget_ended(self) -> None:
        """Release the memory of publishers that have gone."""
        self._receiver.forget_ended()

    def close(self) -> None:
        self._token.close()
        self._receiver.close()


class Readers:
    """The subscriptions of other processes that read this one's memory. One per `Context`."""

    def __init__(self, session: Session, domain: int) -> None:
        self._session, self._domain = session, domain
        self._known: set[tuple[str, int]] = set()
        self._watch: Closable | None = None
        self._listeners: set[Callable[[], None]] = set()

    def read(self, entity: Entity, inbox: Inbox) -> RingReading | None:
        """Let a subscription read rings, and announce it; returns None if memory cannot be shared."""
        receiver = self._session.open_ring_receiver(ring_key(self._domain, entity.data_key), entity.eid, inbox)
        if receiver is None:
            return None
        # Announced last, so that a publisher that sees the token can already reach the receiver.
        token = reader_token(self._domain, Reader(entity.zid, entity.eid, *receiver.reader))
        return RingReading(receiver, self._session.announce(token))

    def follow(self, changed: Callable[[], None]) -> Callable[[], None]:
        """Call `changed` whenever a reader appears or leaves; returns a function that stops this."""
        if self._watch is None:
            self._watch = self._session.watch(readers_key(self._domain), self._token)
        self._listeners.add(changed)
        return lambda: self._listeners.discard(changed)

    def of(self, subscriptions: Iterable[Entity]) -> dict[tuple[str, int], int] | None:
        """Return the queue depths of these subscriptions; None unless all of them read rings."""
        found = {}
        for entity in subscriptions:
            who = (entity.zid, entity.eid)
            if who not in self._known or entity.qos.durability is not Durability.VOLATILE:
                return None
            found[who] = KEEP_ALL_BOUND if entity.qos.history is History.KEEP_ALL else entity.qos.depth
        return found

    def _token(self, token: str, alive: bool) -> None:
        reader = parse_reader(token)
        if reader is None:
            return
        known = (reader.zid, reader.eid)
        if not alive:
            self._known.discard(known)
        elif len(self._known) < READERS_BOUND and self._session.is_neighbour(reader.zid, reader.pid, reader.fd):
            self._known.add(known)
        else:
            return
        for changed in tuple(self._listeners):
            changed()
