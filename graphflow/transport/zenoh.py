"""The network over Eclipse Zenoh, configured as rmw_zenoh's peers expect.

Zenoh calls back on its own threads. Callbacks only append to an inbox and ring its bell: a call into Zenoh, a log line
or user code in a callback can stall every other stream of the process.

Data arrives on Zenoh's default callback thread, one per subscription, which takes many samples each time it holds the
GIL. Requests, replies and tokens arrive directly (see `foreign_threads`), since the default would start a thread per
declaration and per call. So does the feedback of actions, which a result must not overtake.

Large messages between processes of one user go through graphflow's own shared memory (`shared_memory`). Zenoh's is
off, as in ROS 2: it is slower, since it copies in and out, and its watchdogs wake every idle process 18 times a second.
"""

from __future__ import annotations

import logging
import os
import threading
from asyncio import AbstractEventLoop
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import zenoh

from graphflow.domain import rendezvous_endpoint
from graphflow.qos import Durability, Qos, Reliability
from graphflow.transport.base import EARLY, Answer, Payload, Sender
from graphflow.transport.config import (
    QUERY_LIMIT_MS,
    close_at_exit,
    close_session,
    config,
    open_session,
)
from graphflow.transport.event_loop.foreign_threads import at_once
from graphflow.transport.event_loop.loop import in_thread
from graphflow.transport.inbox import Bell, DeepInbox, Inbox
from graphflow.transport.latched import AskingAgain, load_ext
from graphflow.transport.questions import Questions

if TYPE_CHECKING:  # only nodes with large messages load them
    from graphflow.transport.shared_memory.large_messages import RingReceiver, RingSender

OWN = "@graphflow/"
"""Prefix of keys unknown to ROS 2."""
ASKED_BOUND = 10_000
"""Most tokens of a reply: other processes may announce any number."""
WATCHED_AT_ONCE = 64
"""Tokens processed per iteration of the event loop."""
logger = logging.getLogger("graphflow.transport")


class _Declared:
    """A Zenoh declaration, until closed."""

    def __init__(self, session: ZenohSession, *declarations: Any) -> None:
        self._session, self._declarations = session, declarations

    def close(self) -> None:
        declarations, self._declarations = self._declarations, ()
        if self._session.left is not None:
            self._session.left.append(declarations)
            return
        for declaration in declarations:
            try:
                declaration.undeclare()
            except zenoh.ZError as error:  # the session is already closed
                logger.debug("undeclare: %s", error)


class _ZenohSender(_Declared):
    """A plain publisher that knows whether there are subscribers."""

    def __init__(self, session: ZenohSession, publisher: Any, changed: Callable[[], None] | None) -> None:
        self._publisher, self._lock, self._is_wanted = publisher, threading.Lock(), False
        self._inbox = None if changed is None else Inbox(session.bell, 1, changed)
        # The state is polled: a callback needs the GIL on one of the threads that `config` describes, and when a peer
        # leaves there would be one for each publisher at once.
        channel: Any = zenoh.handlers.RingChannel(1)
        handler = channel if self._inbox is None else at_once(self._matching)
        listener = publisher.declare_matching_listener(handler)
        self._news = listener.handler.try_recv if self._inbox is None else _nothing
        super().__init__(session, listener, publisher)
        # Bound here, since a method that only passes on would cost each message a call.
        self.put = publisher.put
        # Subscribers may have been reported by now, but their leaving never will be.
        if publisher.matching_status.matching:
            self._is_wanted = True

    @property
    def is_wanted(self) -> bool:
        """Whether there are subscribers. From any thread."""
        if self._news() is not None:
            with self._lock:  # the last caller has the latest state
                self._is_wanted = self._publisher.matching_status.matching
        return self._is_wanted

    def _matching(self, status: Any) -> None:
        self._is_wanted = status.matching
        assert self._inbox is not None
        self._inbox.put(status)

    def close(self) -> None:
        if self._inbox is not None:
            self._inbox.ready = _nothing  # it may already be rung
        self._news = _nothing
        super().close()
        self._is_wanted = False


class _KeepingSender(_Declared):
    """An advanced publisher, which keeps messages for late subscribers."""

    is_wanted = True

    def __init__(self, session: ZenohSession, publisher: Any) -> None:
        super().__init__(session, publisher)
        self.put = publisher.put


class _ZenohRequest:
    """One query, answered at most once."""

    __slots__ = ("_key", "_query")

    def __init__(self, query: zenoh.Query, key: str) -> None:
        self._query, self._key = query, key

    @property
    def payload(self) -> bytes:
        payload = self._query.payload
        return payload.to_bytes() if payload is not None else b""

    @property
    def size(self) -> int:
        try:
            payload = self._query.payload
        except zenoh.ZError:  # it was answered in the meantime, as another thread inspects the waiting queries
            return 0
        return 0 if payload is None else len(payload)

    @property
    def attachment(self) -> bytes | None:
        try:
            attachment = self._query.attachment
        except zenoh.ZError:  # it was answered in the meantime
            return None
        return attachment.to_bytes() if attachment is not None else None

    def reply(self, payload: Payload, attachment: bytes) -> None:
        with self._query as query:  # the query itself determines whether the reply may be dropped
            query.reply(self._key, payload, attachment=attachment)

    def reply_error(self, payload: bytes) -> None:
        with self._query as query:
            query.reply_err(payload)


class _ZenohCaller(_Declared):
    def __init__(self, session: ZenohSession, querier: zenoh.Querier, changed: Callable[[], None]) -> None:
        def deliver() -> None:
            while inbox.items:
                self.has_server = inbox.items.popleft().matching
            changed()

        inbox = Inbox(session.bell, None, deliver)
        listener = querier.declare_matching_listener(at_once(inbox.put))
        super().__init__(session, listener, querier)
        self._querier, self._bell = querier, session.bell
        # The listener reports after this, and in order.
        self.has_server: bool = querier.matching_status.matching  # type: ignore[attr-defined]

    def call(
        self, payload: Payload, attachment: bytes, answered: Callable[[Answer | None], None]
    ) -> Callable[[], None]:
        wanted = True

        def deliver() -> None:
            while inbox.items and wanted:
                reply = inbox.items.popleft()
                answered(None if reply is None else _answer(reply))

        inbox = Inbox(self._bell, None, deliver)
        # Without it, an abandoned query would stay open until `QUERY_LIMIT_MS`.
        token = zenoh.CancellationToken()
        self._querier.get(
            at_once(inbox.put, lambda: inbox.put(None)),
            payload=payload,
            attachment=attachment,
            cancellation_token=token,
        )

        def give_up() -> None:
            nonlocal wanted
            wanted = False
            token.cancel()  # type: ignore[no-untyped-call]

        return give_up


def _answer(reply: zenoh.Reply) -> Answer:
    sample = reply.ok
    if sample is None:
        error = reply.err
        return Answer(error.payload.to_bytes() if error is not None else b"", None, True)
    attachment = sample.attachment
    return Answer(sample.payload.to_bytes(), attachment.to_bytes() if attachment is not None else None, False)


class ZenohSession:
    """A node process's session: a peer on loopback that discovers the others through the rendezvous.

    Args:
        loop: The loop for all deliveries.
        mode: `peer`, or `client` to pass all traffic through the rendezvous.

    Raises:
        TransportError: Zenoh failed.
    """

    def __init__(self, loop: AbstractEventLoop, mode: str = "peer") -> None:
        listen = "tcp/127.0.0.1:0" if mode == "peer" else None
        self.raw = open_session(config(mode, connect=[rendezvous_endpoint()], listen=listen))
        close_at_exit(self.raw)
        self.zid = str(self.raw.info.zid())
        self.bell = Bell(loop)
        self.loop = loop
        self.left: list[tuple[Any, ...]] | None = None
        """Declarations that closing the session will withdraw; referenced, since Zenoh withdraws unreferenced ones."""
        self._proof = -1
        """The file that proves to other processes that this one is on their machine."""

    def open_sender(
        self, key: str, qos: Qos, changed: Callable[[], None] | None = None, *, only_others: bool = False
    ) -> _ZenohSender | _KeepingSender:
        reliable = qos.reliability is Reliability.RELIABLE
        # DROP even for reliable topics: with BLOCK one stopped receiver blocks the sending loop for seconds.
        options: dict[str, Any] = {
            "congestion_control": zenoh.CongestionControl.DROP,
            "reliability": zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
        }
        if qos.durability is Durability.VOLATILE:
            reach = zenoh.Locality.REMOTE if only_others else zenoh.Locality.ANY
            publisher = self.raw.declare_publisher(key, allowed_destination=reach, **options)
            return _ZenohSender(self, publisher, changed)
        ext = load_ext()
        publisher = ext.declare_advanced_publisher(
            self.raw,
            key,
            cache=ext.CacheConfig(max_samples=qos.depth),
            publisher_detection=True,
            # As rmw_zenoh: without heartbeats, the loss of the last message before a pause would go unnoticed.
            sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5) if reliable else None,
            **options,
        )
        return _KeepingSender(self, publisher)

    def open_receiver(
        self, key: str, qos: Qos, inbox: Inbox, *, ignore_local: bool = False, in_order: bool = False
    ) -> _Declared:
        origin = zenoh.Locality.REMOTE if ignore_local else zenoh.Locality.ANY
        if qos.durability is Durability.VOLATILE:
            put: Callable[[zenoh.Sample], None] = inbox.put
            if isinstance(inbox, DeepInbox):
                from graphflow.transport.copied_samples import copying  # most queues are short

                put = copying(inbox)
            # Replies arrive directly, and would overtake samples that wait for the subscription's own thread.
            handler = at_once(put) if in_order else put
            return _Declared(self, self.raw.declare_subscriber(key, handler, allowed_origin=origin))
        ext = load_ext()
        reliable = qos.reliability is Reliability.RELIABLE
        again = AskingAgain(self.raw, self.loop, self.watch, key, inbox) if reliable else None
        subscriber = ext.declare_advanced_subscriber(
            self.raw,
            key,
            inbox.put if again is None else again.heard,
            history=ext.HistoryConfig(detect_late_publishers=True, max_samples=qos.depth),
            recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True) if reliable else None,
            subscriber_detection=True,
            allowed_origin=origin,
        )
        return _Declared(self, subscriber) if again is None else _Declared(self, subscriber, again)

    def open_large_sender(self, sender: Sender, key: str) -> RingSender | None:
        from graphflow.transport.shared_memory.large_messages import RingSender, can_share

        # A kept message must outlive its slot, so TRANSIENT_LOCAL senders have no ring.
        if not can_share() or isinstance(sender, _KeepingSender):
            return None
        raw = self.raw

        def describe(descriptor: bytes, attachment: bytes) -> None:
            raw.put(
                key,
                descriptor,
                attachment=attachment,
                congestion_control=zenoh.CongestionControl.DROP,
                # Receivers in this session get the message itself.
                allowed_destination=zenoh.Locality.REMOTE,
            )

        return RingSender(sender, describe)

    def open_ring_receiver(self, key: str, eid: int, inbox: Inbox) -> RingReceiver | None:
        from graphflow.transport.shared_memory.large_messages import RingReceiver, can_share, receive
        from graphflow.transport.shared_memory.ring import RingReader, number_of, open_proof

        if not can_share():
            return None
        if self._proof < 0:
            self._proof = open_proof(self.zid)
        rings = RingReader(number_of(self.zid, eid))
        subscriber = self.raw.declare_subscriber(key, receive(rings, inbox), allowed_origin=zenoh.Locality.REMOTE)
        return RingReceiver((os.getpid(), self._proof), rings, _Declared(self, subscriber))

    def is_neighbour(self, zid: str, pid: int, fd: int) -> bool:
        from graphflow.transport.shared_memory.ring import is_proved

        return is_proved(zid, pid, fd)

    def open_server(self, key: str, inbox: Inbox, *, is_paced: bool = False) -> _Declared:
        def arrived(query: zenoh.Query) -> None:
            inbox.put(_ZenohRequest(query, key))

        if is_paced:
            return _Declared(self, Questions(self.raw, key, arrived, complete=True))
        return _Declared(self, self.raw.declare_queryable(key, at_once(arrived), complete=True))

    def open_caller(self, key: str, changed: Callable[[], None]) -> _ZenohCaller:
        # Target and consolidation are rmw_zenoh's. DROP, as for publishers: a stopped server must not block the loop.
        querier = self.raw.declare_querier(
            key,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=QUERY_LIMIT_MS / 1000,
            congestion_control=zenoh.CongestionControl.DROP,
        )
        return _ZenohCaller(self, querier, changed)

    def announce(self, token: str) -> _Declared:
        return _Declared(self, self.raw.liveliness().declare_token(token))

    def watch(self, key: str, changed: Callable[[str, bool], None]) -> _Declared:
        def deliver() -> None:
            for _ in range(min(WATCHED_AT_ONCE, len(inbox.items))):
                sample = inbox.items.popleft()
                changed(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)
            if inbox.items:  # a storm of tokens must not monopolize the loop
                self.loop.call_soon(deliver)

        inbox = Inbox(self.bell, None, deliver)
        # With `history` instead of a query: just after the session was opened, a query finds no tokens.
        subscriber = self.raw.liveliness().declare_subscriber(key, at_once(inbox.put), history=True)
        return _Declared(self, subscriber)

    def ask_tokens(self, key: str, limit: float, told: Callable[[list[str]], None]) -> None:
        # Not by a query: of those of a session with several peers, some end without any of the replies.
        found: dict[str, None] = {}

        def changed(token: str, alive: bool) -> None:
            if not alive:
                found.pop(token, None)
            elif len(found) < ASKED_BOUND:
                found[token] = None

        def ended() -> None:
            watch.close()
            told(list(found))

        watch = self.watch(key, changed)

        self.loop.call_later(limit, ended)

    def open_report(self, key: str, report: Callable[[], bytes]) -> _Declared:
        def asked(query: zenoh.Query) -> None:
            with query:
                query.reply(key, report())

        return _Declared(self, Questions(self.raw, key, asked))  # on a thread: the loop may be blocked

    def ask_reports(self, key: str, limit: float, told: Callable[[list[bytes], bool], None]) -> None:
        found: list[bytes] = []
        early = self.loop.call_later(EARLY, lambda: told(found.copy(), False))

        def deliver() -> None:
            while inbox.items:
                reply = inbox.items.popleft()
                if reply is None:
                    early.cancel()
                    told(found, True)
                elif reply.ok is not None:
                    found.append(reply.ok.payload.to_bytes())

        inbox = Inbox(self.bell, None, deliver)
        self.raw.get(
            key,
            at_once(inbox.put, lambda: inbox.put(None)),
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=limit,
            congestion_control=zenoh.CongestionControl.DROP,
        )

    def watch_transports(self, changed: Callable[[str, bool], None]) -> _Declared:
        """Call `changed(zid, alive)` on the loop whenever a connection to another session starts or ends."""

        def deliver() -> None:
            while inbox.items:
                event = inbox.items.popleft()
                changed(str(event.transport.zid), event.kind == zenoh.SampleKind.PUT)

        inbox = Inbox(self.bell, None, deliver)
        listener = self.raw.info.declare_transport_events_listener(at_once(inbox.put))
        return _Declared(self, listener)

    def routers(self) -> list[str]:
        """Return the ids of the routers that this session is connected to."""
        return [str(zid) for zid in self.raw.info.routers_zid()]

    def read(self, arrival: Any) -> tuple[bytes, bytes | None]:
        attachment = arrival.attachment
        return arrival.payload.to_bytes(), attachment.to_bytes() if attachment is not None else None

    def key_of(self, arrival: Any) -> str:
        return str(arrival.key_expr)

    def leave(self) -> None:
        self.left = []

    async def close(self) -> None:
        await in_thread(lambda: close_session(self.raw))
        # After the session, whose callbacks may ring it to the last.
        self.bell.close()
        if self._proof >= 0:
            os.close(self._proof)


def _nothing() -> None:
    """Do nothing: the session is closed."""
