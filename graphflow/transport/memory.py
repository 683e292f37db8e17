"""A network inside one process, for tests and notebooks, with the guarantees of the real one but without threads.

The loop delivers everything in the order of sending, never inside the sending call. As over Zenoh, a request goes to
every server on its key, and a TRANSIENT_LOCAL sender keeps its last messages for receivers that query them. Keys match
exactly, except for receivers whose key ends with the part `*`.
"""

from __future__ import annotations

import itertools
from asyncio import AbstractEventLoop
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import NamedTuple, Protocol
from weakref import WeakSet

from graphflow.qos import Durability, Qos
from graphflow.transport.base import Answer, LargeSender, Payload, RingReceiver, Sender
from graphflow.transport.inbox import Bell, Inbox

_zids = itertools.count(1)


class _Sample(NamedTuple):
    payload: bytes
    attachment: bytes | None
    key: str


class _Receiver(NamedTuple):
    inbox: Inbox
    zid: str
    """The session's id."""
    ignore_local: bool


class Carrier(Protocol):
    """The transmission between sessions: decides when, and whether, an item is delivered."""

    def carry(self, deliver: Callable[[], object], link: str, *, is_lossy: bool) -> None:
        """Transmit an item.

        Args:
            link: Sender, receiver and key: items on one link arrive in order.
            is_lossy: Whether the item may be lost, as publications may.
        """


class Network:
    """The medium that memory sessions share.

    Args:
        carrier: The transmission; by default everything arrives at once.
    """

    def __init__(self, carrier: Carrier | None = None) -> None:
        self.carrier = carrier
        self.senders: dict[str, list[_Sender]] = {}
        self.receivers: dict[str, list[_Receiver]] = {}
        self.servers: dict[str, list[Inbox]] = {}
        self.callers: dict[str, list[_Caller]] = {}
        self.reports: dict[str, Callable[[], bytes]] = {}
        self.requests: dict[int, WeakSet[_Request]] = {}
        """Unanswered requests, by the server's inbox."""
        self.tokens: dict[str, None] = {}
        self.watchers: list[tuple[str, Callable[[str, bool], None]]] = []

    def receivers_of(self, key: str) -> list[_Receiver]:
        """Return the receivers of publications on a key."""
        return [*self.receivers.get(key, ()), *self.receivers.get(_any_of(key), ())]

    def senders_to(self, key: str) -> list[_Sender]:
        """Return the senders whose messages a receiver on a key receives."""
        return [s for k, senders in self.senders.items() if key in (k, _any_of(k)) for s in senders]

    def deliver(self, deliver: Callable[[], object], link: str, *, is_lossy: bool = False) -> None:
        """Deliver an item through the carrier."""
        if self.carrier is None:
            deliver()
        else:
            self.carrier.carry(deliver, link, is_lossy=is_lossy)

    def session(self, loop: AbstractEventLoop) -> MemorySession:
        """Return a session for a new participant."""
        return MemorySession(self, loop)


class _Declared:
    """An entry in one of the network's lists, until closed."""

    def __init__(self, undo: Callable[[], None]) -> None:
        self._undo: Callable[[], None] | None = undo

    def close(self) -> None:
        undo, self._undo = self._undo, None
        if undo is not None:
            undo()


class _Sender:
    def __init__(
        self,
        network: Network,
        key: str,
        qos: Qos,
        zid: str,
        changed: Callable[[], None] | None = None,
        *,
        only_others: bool = False,
    ) -> None:
        self._network, self._key, self.zid = network, key, zid
        self._changed = changed
        self._is_closed = False
        keeps = qos.durability is Durability.TRANSIENT_LOCAL
        self._only_others = only_others and not keeps
        self.history: deque[_Sample] = deque(maxlen=qos.depth if keeps else 0)
        network.senders.setdefault(key, []).append(self)

    @property
    def is_wanted(self) -> bool:
        return bool(self.history.maxlen or self._receivers())

    def _receivers(self) -> list[_Receiver]:
        found = self._network.receivers_of(self._key)
        return [r for r in found if not (r.zid == self.zid and (self._only_others or r.ignore_local))]

    def tell_changed(self) -> None:
        if self._changed is not None:
            self._changed()

    def put(self, payload: Payload, *, attachment: bytes) -> None:
        if self._is_closed:  # its session has died, which its node has not noticed
            return
        sample = _Sample(bytes(payload), attachment, self._key)
        self.history.append(sample)
        for receiver in self._receivers():
            put, inbox = receiver.inbox.put, receiver.inbox
            link = f"{self.zid}>{receiver.zid} {self._key} {id(inbox)}"
            self._network.deliver(partial(put, sample), link, is_lossy=True)

    def close(self) -> None:
        self._changed, self._is_closed = None, True
        if self in self._network.senders.get(self._key, ()):
            self._network.senders[self._key].remove(self)


class _Request:
    def __init__(self, payload: bytes, attachment: bytes, call: _Call) -> None:
        self.payload, self.attachment, self.size = payload, attachment, len(payload)
        self._call: _Call | None = call

    def reply(self, payload: Payload, attachment: bytes) -> None:
        self._finish(Answer(bytes(payload), attachment))

    def reply_error(self, payload: bytes) -> None:
        self._finish(Answer(payload, None, is_error=True))

    def abandon(self) -> None:
        """End a request whose server has died."""
        self._finish(None)

    def _finish(self, answer: Answer | None) -> None:
        call, self._call = self._call, None
        if call is not None:
            call.server_done(answer)

    def __del__(self) -> None:
        # As Zenoh does, which ends a query with the last reference to it.
        if self._call is not None:
            self._call.server_done(None)


class _Call:
    def __init__(
        self, network: Network, loop: AbstractEventLoop, servers: int, answered: Callable[[Answer | None], None]
    ) -> None:
        self._network, self._loop, self._open, self._answered = network, loop, servers, answered
        self._given_up = False

    def server_done(self, answer: Answer | None) -> None:
        if not self._loop.is_closed():
            arrive = partial(self._loop.call_soon, self._arrive, answer)
            self._network.deliver(arrive, f"answer {id(self)}")

    def _arrive(self, answer: Answer | None) -> None:
        self._open -= 1
        if answer is not None and not self._given_up:
            self._answered(answer)
        if self._open <= 0 and not self._given_up:
            self._answered(None)

    def give_up(self) -> None:
        self._given_up = True


class _Caller:
    def __init__(self, network: Network, loop: AbstractEventLoop, key: str, changed: Callable[[], None]) -> None:
        self._network, self._loop, self._key = network, loop, key
        self._changed = changed
        network.callers.setdefault(key, []).append(self)

    def servers_changed(self) -> None:
        if not self._loop.is_closed():
            self._loop.call_soon(self._changed)

    def call(
        self, payload: Payload, attachment: bytes, answered: Callable[[Answer | None], None]
    ) -> Callable[[], None]:
        servers = self._network.servers.get(self._key, [])
        call = _Call(self._network, self._loop, len(servers), answered)
        if not servers:
            call.server_done(None)
        for inbox in servers:
            request = _Request(bytes(payload), attachment, call)
            self._network.requests.setdefault(id(inbox), WeakSet()).add(request)
            self._network.deliver(partial(inbox.put, request), f"ask {id(self)} {id(inbox)}")
        return call.give_up

    @property
    def has_server(self) -> bool:
        return bool(self._network.servers.get(self._key))

    def close(self) -> None:
        if self in self._network.callers.get(self._key, ()):
            self._network.callers[self._key].remove(self)


class MemorySession:
    """One participant of a `Network`."""

    def __init__(self, network: Network, loop: AbstractEventLoop) -> None:
        self.zid = f"{next(_zids):x}"
        self.bell = Bell(loop, threads=False)
        self._network, self._loop = network, loop
        self._declared: list[_Declared] = []
        self._served: list[Inbox] = []

    def open_sender(
        self, key: str, qos: Qos, changed: Callable[[], None] | None = None, *, only_others: bool = False
    ) -> _Sender:
        sender = _Sender(self._network, key, qos, self.zid, changed, only_others=only_others)
        self._keep(_Declared(sender.close))
        return sender

    def open_receiver(
        self, key: str, qos: Qos, inbox: Inbox, *, ignore_local: bool = False, in_order: bool = False
    ) -> _Declared:
        if qos.durability is Durability.TRANSIENT_LOCAL:
            for sender in self._network.senders.get(key, ()):
                for sample in list(sender.history)[-qos.depth :]:
                    if not (ignore_local and sender.zid == self.zid):
                        inbox.put(sample)
        receivers = self._network.receivers.setdefault(key, [])
        receiver = _Receiver(inbox, self.zid, ignore_local)
        receivers.append(receiver)
        self._tell_senders(key)

        def withdraw() -> None:
            receivers.remove(receiver)
            self._tell_senders(key)

        return self._keep(_Declared(withdraw))

    def _tell_senders(self, key: str) -> None:
        for sender in self._network.senders_to(key):
            if not self._loop.is_closed():
                self._loop.call_soon(sender.tell_changed)

    def open_large_sender(self, sender: Sender, key: str) -> LargeSender | None:
        return None

    def open_ring_receiver(self, key: str, eid: int, inbox: Inbox) -> RingReceiver | None:
        return None

    def is_neighbour(self, zid: str, pid: int, fd: int) -> bool:
        return False

    def open_server(self, key: str, inbox: Inbox, *, is_paced: bool = False) -> _Declared:
        servers = self._network.servers.setdefault(key, [])
        servers.append(inbox)
        self._served.append(inbox)
        self._tell_callers(key)

        def withdraw() -> None:
            servers.remove(inbox)
            self._tell_callers(key)

        return self._keep(_Declared(withdraw))

    def _tell_callers(self, key: str) -> None:
        for caller in self._network.callers.get(key, ()):
            caller.servers_changed()

    def open_caller(self, key: str, changed: Callable[[], None]) -> _Caller:
        caller = _Caller(self._network, self._loop, key, changed)
        self._keep(_Declared(caller.close))
        return caller

    def open_report(self, key: str, report: Callable[[], bytes]) -> _Declared:
        self._network.reports[key] = report

        def withdraw() -> None:
            del self._network.reports[key]

        return self._keep(_Declared(withdraw))

    def ask_reports(self, key: str, limit: float, told: Callable[[list[bytes], bool], None]) -> None:
        reports = [report for known, report in self._network.reports.items() if key in (known, _any_of(known))]
        self._loop.call_soon(lambda: told([report() for report in reports], True))

    def announce(self, token: str) -> _Declared:
        self._network.tokens[token] = None
        self._tell(token, True)

        def withdraw() -> None:
            self._network.tokens.pop(token, None)
            self._tell(token, False)

        return self._keep(_Declared(withdraw))

    def watch(self, key: str, changed: Callable[[str, bool], None]) -> _Declared:
        watcher = (key, changed)
        self._network.watchers.append(watcher)
        for token in self._network.tokens:
            if _matches(key, token):
                self._loop.call_soon(changed, token, True)
        return self._keep(_Declared(lambda: self._network.watchers.remove(watcher)))

    def ask_tokens(self, key: str, limit: float, told: Callable[[list[str]], None]) -> None:
        self._loop.call_soon(lambda: told([token for token in self._network.tokens if _matches(key, token)]))

    def read(self, arrival: _Sample) -> tuple[bytes, bytes | None]:
        return arrival.payload, arrival.attachment

    def key_of(self, arrival: _Sample) -> str:
        return arrival.key

    def die(self) -> None:
        """Vanish at once, like a killed process: pending requests get no reply."""
        for declared in reversed(self._declared):
            declared.close()
        self._declared.clear()
        for inbox in self._served:
            for request in list(self._network.requests.pop(id(inbox), ())):
                request.abandon()

    def leave(self) -> None:
        """Do nothing: closing takes no time here."""

    async def close(self) -> None:
        for declared in reversed(self._declared):
            declared.close()
        self._declared.clear()
        self.bell.close()

    def _tell(self, token: str, alive: bool) -> None:
        for key, changed in self._network.watchers:
            if _matches(key, token) and not self._loop.is_closed():
                self._loop.call_soon(changed, token, alive)

    def _keep(self, declared: _Declared) -> _Declared:
        self._declared.append(declared)
        return declared


def _any_of(key: str) -> str:
    """Return the key with `*` for its last part."""
    return f"{key.rpartition('/')[0]}/*"


def _matches(key: str, token: str) -> bool:
    if "/*/" not in key:
        return token.startswith(key.removesuffix("**")) if key.endswith("/**") else token == key
    wanted, parts = key.removesuffix("/**").split("/"), token.split("/")
    is_long_enough = len(parts) > len(wanted) if key.endswith("/**") else len(parts) == len(wanted)
    return is_long_enough and all(chunk in ("*", part) for chunk, part in zip(wanted, parts, strict=False))
