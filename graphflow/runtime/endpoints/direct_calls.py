"""Direct calls between graphflow processes: request and response as two publications, where a query costs three.

For a query, Zenoh keeps state of every call in each process on the way and delivers each reply separately. ROS 2 uses
only queries, so every service answers them; two graphflow processes also open a *line*, on keys that no ROS 2
wildcard matches:

    @graphflow/<domain>/ask/<server's zid>/<server's eid>       requests, from any client
    @graphflow/<domain>/answer/<client's zid>/<client's eid>    responses, from any server

Each publication carries the same attachment as in ROS 2; the sequence number of an error is negative. A line is used
only once both directions work. The client's process sends sequence number 0 when its requests have a listener, with the
key of its responses, and the server's process sends 0 when it has a listener on that key. Until then, and with another
kind of server or several servers, calls are queries.
"""

from __future__ import annotations

import logging
from asyncio import AbstractEventLoop
from collections import OrderedDict
from collections.abc import Callable
from typing import Any, NamedTuple

from graphflow.errors import DecodeError, RemoteError, ServerBusy
from graphflow.executor.runner import BURST, Runner
from graphflow.qos import SERVICES
from graphflow.transport.base import Answer, Closable, Payload, Sender, Session
from graphflow.transport.inbox import BYTES_BOUND, REQUESTS_BOUND, Inbox, RequestInbox, size_of
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity

logger = logging.getLogger("graphflow")

_HELLO = 0
"""The sequence number that opens a line."""
EARLY_BOUND = 256
"""Hellos kept until the client's token arrives."""
_NO_ROOM = RemoteError(ServerBusy.__name__, "too much waited for a process that did not attend to it").to_payload()
"""The response to a refused request."""
_DEPTH = {"ask": REQUESTS_BOUND, "answer": 10 * REQUESTS_BOUND}
"""Queue lengths. There are no more responses than calls under way, which are limited already."""
_NAMES = {"ask": "requests of other processes", "answer": "answers of other processes"}
_WHERE_BOUND = 80
"""Longest hello, in bytes: a session's id and an endpoint's."""

Heard = Callable[[bytes | None, bytes, int, bytes], None]
"""Called with an arrival: payload, attachment, and the attachment's sequence number and GID. The payload is None if the
queue was full."""


class _Refused(NamedTuple):
    """The attachment of a request refused by a full queue, kept for the error response."""

    key: str
    attachment: bytes | None


class _Listener(NamedTuple):
    """An endpoint of this process that receives on lines."""

    heard: Heard
    runner: Runner | None
    """The runner that requests queue for."""


class Switchboard:
    """A process's ends of all lines: dispatches arrivals to listeners. One per `Context`."""

    def __init__(self, session: Session, domain: int, loop: AbstractEventLoop) -> None:
        self._session, self._domain, self._loop = session, domain, loop
        self._listeners: dict[tuple[str, str], _Listener] = {}
        """Listeners, by `ask` or `answer` and endpoint id."""
        self._receivers: dict[str, Closable] = {}
        self._inboxes: dict[str, Inbox] = {}

    def arrived(self) -> list[tuple[Runner, bytes, int]]:
        """Return the requests that the loop has not processed yet: (runner, client GID, sequence number) each."""
        found: list[tuple[Runner, bytes, int]] = []
        session = self._session
        for arrival in list(self._inboxes["ask"].items) if "ask" in self._inboxes else ():
            if arrival.__class__ is _Refused:
                continue
            listener = self._listeners.get(("ask", session.key_of(arrival).rpartition("/")[2]))
            try:
                sequence, _, gid = attachment.fields((session.read(arrival)[1] or b"")[: attachment.SIZE])
            except DecodeError:
                continue
            if listener is not None and listener.runner is not None:
                found.append((listener.runner, gid, sequence))
        return found

    def key(self, what: str, zid: str, eid: str) -> str:
        return f"@graphflow/{self._domain}/{what}/{zid}/{eid}"

    def listen(self, what: str, entity: Entity, heard: Heard, runner: Runner | None = None) -> None:
        """Call `heard` with the arrivals for an endpoint of this process."""
        self._listeners[what, str(entity.eid)] = _Listener(heard, runner)
        if what not in self._receivers:
            # One subscriber per process, since Zenoh starts a thread for each.
            session = self._session
            inbox: RequestInbox

            def deliver() -> None:
                self._deliver(what, inbox)

            def refuse(arrival: Any) -> _Refused:
                return _Refused(session.key_of(arrival), session.read(arrival)[1])

            inbox = self._inboxes[what] = RequestInbox(session.bell, _DEPTH[what], deliver, size_of, refuse)
            inbox.tell_losses(lambda: warn_of_refused(inbox, _NAMES[what]), 1)
            options = {"in_order": True}  # a thread in between would cost a tenth of a call
            self._receivers[what] = session.open_receiver(self.key(what, session.zid, "*"), SERVICES, inbox, **options)

    def _deliver(self, what: str, inbox: Inbox) -> None:
        session, listeners = self._session, self._listeners
        for _ in range(min(BURST, len(inbox.items))):
            arrival = inbox.items.popleft()
            refused = arrival if arrival.__class__ is _Refused else None
            key = session.key_of(arrival) if refused is None else refused.key
            listener = listeners.get((what, key.rpartition("/")[2]))
            if listener is not None:
                payload, beside = session.read(arrival) if refused is None else (None, refused.attachment)
                try:
                    sequence, _, gid = attachment.fields((beside or b"")[: attachment.SIZE])
                except DecodeError as error:
                    logger.debug("%s: %s", key, error)
                    continue
                listener.heard(payload, beside or b"", sequence, gid)
        if inbox.items:  # callers that are faster than the handlers must not monopolize the loop
            self._loop.call_soon(self._deliver, what, inbox)

    def forget(self, what: str, entity: Entity) -> None:
        self._listeners.pop((what, str(entity.eid)), None)

    def open_sender(self, what: str, zid: str, eid: str, changed: Callable[[], None]) -> Sender:
        return self._session.open_sender(self.key(what, zid, eid), SERVICES, changed)


def warn_of_refused(inbox: RequestInbox, what: str) -> None:
    """Warn of requests refused by a full queue."""
    logger.warning(
        "%s: %d were refused so far, since %d of them, or %d MB, waited: the event loop is blocked, or they come "
        "faster than it takes them; graphflow waits says where it is",
        what,
        inbox.dropped,
        inbox.depth,
        BYTES_BOUND >> 20,
    )


def unanswered(request: Any) -> None:
    """Drop a query's request: Zenoh reports to its client at once that no reply will come."""


class DirectRequest:
    """A request received over a line; see `transport.base.Request`. Its attachment may end with a call chain."""

    __slots__ = ("_answer", "attachment", "payload", "size")

    def __init__(self, payload: bytes, beside: bytes, answer: Callable[[Payload, bytes], None]) -> None:
        self.payload, self.attachment, self._answer = payload, beside, answer
        self.size = len(payload)

    def reply(self, payload: Payload, attachment: bytes) -> None:
        self._answer(payload, attachment)

    def reply_error(self, payload: bytes) -> None:
        sequence, sent_ns, gid = attachment.fields(self.attachment[: attachment.SIZE])
        self._answer(payload, attachment.pack(-sequence, sent_ns, gid))


class ServerLines:
    """A server's ends of the lines to its clients.

    Args:
        runner: The runner that requests queue for.
        asked: Called with each request.
    """

    def __init__(
        self, switchboard: Switchboard, entity: Entity, runner: Runner, asked: Callable[[DirectRequest], None]
    ) -> None:
        self._switchboard, self._entity, self._runner, self._asked = switchboard, entity, runner, asked
        self._senders: dict[bytes, Sender] = {}
        """Senders to the clients, by GID."""
        self._clients: dict[bytes, str] = {}
        """Ids of announced clients' sessions and endpoints, by GID."""
        self._early: OrderedDict[bytes, str] = OrderedDict()
        """The same from hellos of clients whose tokens have not arrived, by GID."""
        self._is_listening = False
        self._is_closing = False
        self._unanswered = 0

    def client_came(self, client: Entity) -> None:
        """Note a new client, possibly graphflow's."""
        self._clients[client.gid] = where = f"{client.zid}/{client.eid}"
        if not self._is_listening:
            self._is_listening = True
            self._switchboard.listen("ask", self._entity, self._heard, self._runner)
        if self._early.pop(client.gid, "") == where:
            self._open(client.gid, where)

    def client_gone(self, client: Entity) -> None:
        self._clients.pop(client.gid, None)
        sender = self._senders.pop(client.gid, None)
        if sender is not None:
            sender.close()

    def _heard(self, payload: bytes | None, beside: bytes, sequence: int, gid: bytes) -> None:
        if sequence == _HELLO:
            self._greet(payload or b"", gid)
        elif sequence > 0 and gid in self._senders:
            self._unanswered += 1
            request = DirectRequest(payload or b"", beside, self._answer)
            self._asked(request) if payload is not None else request.reply_error(_NO_ROOM)

    def _answer(self, payload: Payload, beside: bytes) -> None:
        sender = self._senders.get(beside[attachment.SIZE - 16 : attachment.SIZE])
        if sender is not None:  # the client may have gone in the meantime
            sender.put(payload, attachment=beside)
        self._unanswered -= 1
        if self._is_closing:
            self.close()

    def _greet(self, where: bytes, gid: bytes) -> None:
        """Accept a client's hello if its token confirms the response key; the token may arrive later."""
        text = where[:_WHERE_BOUND].decode("ascii", "replace")
        if gid in self._clients:
            if text == self._clients[gid] and gid not in self._senders:
                self._open(gid, text)
            return
        self._early[gid] = text
        if len(self._early) > EARLY_BOUND:
            self._early.popitem(last=False)

    def _open(self, gid: bytes, where: str) -> None:
        """Open the response direction to a client."""
        zid, _, eid = where.partition("/")

        def changed() -> None:
            if sender.is_wanted:
                sender.put(b"", attachment=attachment.pack(_HELLO, 0, self._entity.gid))

        sender = self._senders[gid] = self._switchboard.open_sender("answer", zid, eid, changed)
        changed()

    def close(self) -> None:
        """Accept no more requests; those under way are still answered."""
        self._is_closing = True
        self._switchboard.forget("ask", self._entity)
        if not self._unanswered:
            for sender in self._senders.values():
                sender.close()
            self._senders.clear()


class ClientLine:
    """A client's end of the line to one server.

    Args:
        client, server: The entities of the client and the server.
    """

    def __init__(self, switchboard: Switchboard, client: Entity, server: Entity) -> None:
        self.server = server
        self._switchboard, self._client = switchboard, client
        self.is_open = False
        """Whether both directions are known to work."""
        self._pending: dict[int, Callable[[Answer | None], None]] = {}
        switchboard.listen("answer", client, self._heard)
        self._sender = switchboard.open_sender("ask", server.zid, str(server.eid), self._changed)
        self._changed()

    @property
    def is_heard(self) -> bool:
        """Whether the server has a listener for direct requests, as graphflow's do; true before the line is open."""
        return self._sender.is_wanted

    def _changed(self) -> None:
        if not self._sender.is_wanted:
            self.is_open = False
        elif not self.is_open:
            where = f"{self._client.zid}/{self._client.eid}".encode()
            self._sender.put(where, attachment=attachment.pack(_HELLO, 0, self._client.gid))

    def call(
        self, sequence: int, payload: Payload, beside: bytes, answered: Callable[[Answer | None], None]
    ) -> Callable[[], None]:
        """Send a request as `transport.base.Caller.call`; one response arrives, or None when the server goes."""
        self._pending[sequence] = answered
        self._sender.put(payload, attachment=beside)
        return lambda: self._give_up(sequence)

    def _give_up(self, sequence: int) -> None:
        self._pending.pop(sequence, None)

    def _heard(self, payload: bytes | None, beside: bytes, sequence: int, gid: bytes) -> None:
        if sequence == _HELLO:
            self.is_open = self.is_open or (gid == self.server.gid and self._sender.is_wanted)
            return
        answered = self._pending.pop(abs(sequence), None)
        if answered is not None:
            answered(Answer(_NO_ROOM, beside, True) if payload is None else Answer(payload, beside, sequence < 0))

    def close(self) -> None:
        """Close the line. Pending calls end as if the server had gone."""
        self.is_open = False
        self._switchboard.forget("answer", self._client)
        self._sender.close()
        pending, self._pending = self._pending, {}
        for answered in pending.values():
            answered(None)
