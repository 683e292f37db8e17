"""The runtime's interface to a network, as small protocols, and the queues between foreign threads and the loop.

All arrivals take one path: the network's thread appends them to a bounded `Inbox` and rings the `Bell` unless it is
ringing already; the loop empties the inbox. Payloads stay in the network's form until a handler is about to run, so
that a message dropped from a full inbox has cost nothing.
"""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from graphflow.qos import History, Qos
from graphflow.system import is_portable

if TYPE_CHECKING:
    from asyncio import AbstractEventLoop

Payload = bytes | bytearray | memoryview
EARLY = 0.1
"""Seconds after which incomplete reports are passed on."""


KEEP_ALL_BOUND = 10_000
"""Queue length of a KEEP_ALL subscription."""
DEEP = 100
"""Queue length from which the bytes are limited, too, and messages are copied out of the network's buffers."""
BYTES_BOUND = 256 << 20
"""Most bytes of messages in a deep queue, or of requests in a queue."""
REQUESTS_BOUND = 10_000
"""Most requests that wait for the loop."""
STAND_INS = 10
"""Limit of refused items kept for a response, as a multiple of the queue's depth."""


class Closable(Protocol):
    """A declaration on the network, until closed. Closing twice is harmless."""

    def close(self) -> None: ...


class Sender(Closable, Protocol):
    """A publisher on one key."""

    @property
    def is_wanted(self) -> bool:
        """Whether a message sent now would reach a receiver or be kept for one."""

    def put(self, payload: Payload, *, attachment: bytes) -> None:
        """Send without waiting. A slow receiver loses messages; the sender never blocks."""


class Caller(Closable, Protocol):
    """A client of the servers on one key."""

    def call(
        self, payload: Payload, attachment: bytes, answered: Callable[[Answer | None], None]
    ) -> Callable[[], None]:
        """Send a request.

        Args:
            answered: Called on the loop for each reply, and at the end with None.

        Returns:
            A function that abandons the request; no reply is delivered after it.
        """

    @property
    def has_server(self) -> bool:
        """Whether the network knows of a server that this caller would reach."""


class Answer(NamedTuple):
    """One reply to a call."""

    payload: bytes
    attachment: bytes | None = None
    is_error: bool = False


class Request(Protocol):
    """A request at its server. It must be answered exactly once: until then the caller waits."""

    @property
    def payload(self) -> bytes: ...

    @property
    def size(self) -> int:
        """Size of the payload in bytes."""

    @property
    def attachment(self) -> bytes | None: ...

    def reply(self, payload: Payload, attachment: bytes) -> None: ...

    def reply_error(self, payload: bytes) -> None: ...


class Arrival(Protocol):
    """A publication as it arrived, still in the network's memory."""

    @property
    def payload(self) -> bytes: ...

    @property
    def attachment(self) -> bytes | None: ...


class LargeSender(Closable, Protocol):
    """A publisher on one key that sends large messages through shared memory where all receivers can read it."""

    in_memory: int
    """Messages sent through shared memory."""

    @property
    def memory(self) -> int:
        """Bytes of shared memory in use."""

    def admit(self, readers: Mapping[tuple[str, int], int] | None) -> None:
        """Set the receivers.

        Args:
            readers: Their queues' depths, by session and entity, if all can read shared memory; else None.
        """

    def put_parts(self, parts: tuple[list[Any], int], *, attachment: bytes) -> None:
        """Send the result of `Codec.encode_parts`, without waiting."""

    def lend(self, dtype: Any, count: int) -> Any:
        """Return an array to fill in place for the next message; None if it would be copied. One at a time."""

    def take_back(self) -> None:
        """End the loan of the array."""


class RingReceiver(Closable, Protocol):
    """A receiver of descriptors, which replace large messages."""

    reader: tuple[int, int]
    """The proof that this process can read the sender's memory: its process id and a file descriptor."""

    def forget_ended(self) -> None:
        """Release the memory of senders that have gone."""


class Session(Protocol):
    """One process's participation in the network."""

    zid: str
    """The session's id as in tokens: lower-case hex."""
    bell: Bell
    """The bell that this session's inboxes ring."""

    def open_sender(
        self, key: str, qos: Qos, changed: Callable[[], None] | None = None, *, only_others: bool = False
    ) -> Sender:
        """Open a publisher.

        Args:
            changed: Called on the loop when `is_wanted` may have changed; not for TRANSIENT_LOCAL, where it never does.
            only_others: Whether to exclude receivers of this session; not for TRANSIENT_LOCAL.
        """

    def open_receiver(
        self, key: str, qos: Qos, inbox: Inbox, *, ignore_local: bool = False, in_order: bool = False
    ) -> Closable:
        """Put every publication on `key` into `inbox`, for `read` to decode.

        Args:
            key: Its last part may be `*`; `key_of` then returns the full key.
            ignore_local: Whether to exclude this session's own publications.
            in_order: Whether replies sent after a publication must not overtake it; for infrequent messages. Not for
                TRANSIENT_LOCAL.
        """

    def open_large_sender(self, sender: Sender, key: str) -> LargeSender | None:
        """Send large messages through shared memory and others by `sender`; None if memory cannot be shared.

        Args:
            key: The key of the ring receivers.
        """

    def open_ring_receiver(self, key: str, eid: int, inbox: Inbox) -> RingReceiver | None:
        """Put large messages into the inbox of a receiver with `in_order`; None if memory cannot be shared.

        Args:
            eid: The subscription's entity id.
        """

    def is_neighbour(self, zid: str, pid: int, fd: int) -> bool:
        """Whether a session belongs to a process that can read this one's memory, according to its proof."""

    def open_server(self, key: str, inbox: Inbox, *, is_paced: bool = False) -> Closable:
        """Put every request on `key` into `inbox`, as a `Request`.

        Args:
            is_paced: Whether to limit the rate of requests, so that a flood does not hold up the process; excess ones
                end without a reply, oldest first. For graphflow's own keys, on which anybody may query.
        """

    def open_caller(self, key: str, changed: Callable[[], None]) -> Caller:
        """Open a client.

        Args:
            changed: Called on the loop when `has_server` has changed.
        """

    def announce(self, token: str) -> Closable:
        """Declare a liveliness token, which lasts until the process ends or the result is closed."""

    def watch(self, key: str, changed: Callable[[str, bool], None]) -> Closable:
        """Call `changed(token, alive)` on the loop for every matching token, including existing ones."""

    def ask_tokens(self, key: str, limit: float, told: Callable[[list[str]], None]) -> None:
        """Query the matching tokens.

        Args:
            limit: Seconds to collect replies; over a network it always takes that long.
            told: Called on the loop, once, with the tokens that arrived.
        """

    def open_report(self, key: str, report: Callable[[], bytes]) -> Closable:
        """Answer queries on `key` with the result of `report`.

        If there are threads, `report` is called on one of its own, so that it answers while the loop is blocked. The
        rate is limited as with `open_server`'s `is_paced`.
        """

    def ask_reports(self, key: str, limit: float, told: Callable[[list[bytes], bool], None]) -> None:
        """Query all reports whose key matches.

        Args:
            limit: Seconds to collect replies.
            told: Called on the loop with the reports and whether they are complete: once, and if some are missing after
                `EARLY` seconds, also then.
        """

    def read(self, arrival: Any) -> tuple[bytes, bytes | None]:
        """Return payload and attachment of an item that a receiver put into an inbox.

        A payload in shared memory is not a `bytes`, but can be decoded and copied like one.
        """

    def key_of(self, arrival: Any) -> str:
        """Return the key of a publication."""

    def leave(self) -> None:
        """Prepare to close.

        Declarations closed from now on may last until `close`, which withdraws all at once and cannot be delayed by
        peers that are closing, too.
        """

    async def close(self) -> None: ...


class Rings(Protocol):
    """The wake-up of consumers of inboxes: the loop, by a `Bell`, or other threads."""

    rung: deque[Inbox]
    """Inboxes to be emptied."""
    pending: bool
    """Whether a wake-up is pending."""

    def ring(self) -> None:
        """Wake the consumer. Callable from any thread."""


class Bell:
    """The wake-up of the loop, once per burst.

    Args:
        loop: The loop to wake.
        threads: Whether other threads than the loop's ring the bell.
    """

    def __init__(self, loop: AbstractEventLoop, *, threads: bool = True) -> None:
        self._loop = loop
        self.rung: deque[Inbox] = deque()
        """Inboxes to be emptied."""
        self.pending = False
        """Whether a wake-up of the loop is pending."""
        self._closed = False
        self._wake = loop.call_soon_threadsafe if threads else loop.call_soon
        self._fd: int | None = None
        if threads and not is_portable():
            self._fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
            if hasattr(loop, "hang_bell"):
                loop.hang_bell(self._fd, self._attend)
            else:
                loop.add_reader(self._fd, self._answer)

    def ring(self) -> None:
        """Make the loop empty the inboxes in `rung`. Callable from any thread."""
        if self._closed:
            return
        self.pending = True
        fd = self._fd
        if fd is not None:
            os.eventfd_write(fd, 1)
        elif not self._loop.is_closed():
            self._wake(self._attend)

    def _answer(self) -> None:
        assert self._fd is not None
        os.eventfd_read(self._fd)
        self._attend()

    def _attend(self) -> None:
        self.pending = False
        rung = self.rung
        while rung and not self._closed:
            inbox = rung.popleft()
            inbox.ringing = False  # before the queue is read, so that an arrival from now on rings again
            try:
                inbox.ready()
            except Exception as error:  # one inbox's failure must not affect the others
                self._loop.call_exception_handler({"message": f"{inbox.ready} failed", "exception": error})

    def close(self) -> None:
        """Stop waking the loop; pending rings are lost."""
        self._closed = True
        if self._fd is not None:
            getattr(self._loop, "take_down_bell", self._loop.remove_reader)(self._fd)
            os.close(self._fd)
            self._fd = None


class Inbox:
    """A bounded queue that a foreign thread fills and the loop empties; when full, the oldest item is dropped.

    Args:
        bell: Wakes the consumer, usually the loop.
        depth: Longest queue; None for no limit.
        ready: Called by the consumer when there are new items.
    """

    __slots__ = ("_bell", "_losses", "_tell_at", "dropped", "items", "ready", "ringing")

    def __init__(self, bell: Rings, depth: int | None, ready: Callable[[], None]) -> None:
        self.items: deque[Any] = deque(maxlen=depth)
        self.ready = ready
        self.dropped = 0
        """Items lost to a full queue."""
        self.ringing = False
        """Whether the bell has been rung for the queued items."""
        self._bell = bell
        self._losses: Inbox | None = None
        """A companion inbox that rings the bell for losses."""
        self._tell_at = sys.maxsize
        """The number of losses at the next report."""

    def tell_losses(self, told: Callable[[], None], first: int) -> None:
        """Let the consumer call `told` at the `first` loss and whenever the losses have doubled.

        It is the only sign of a queue that is no longer emptied. It costs nothing while there are no losses.
        """
        self._losses, self._tell_at = Inbox(self._bell, 1, told), first

    def put(self, item: Any) -> None:
        """Add an item. Callable from any thread; of two simultaneous losses on two threads, one may not be counted."""
        items = self.items
        if len(items) == items.maxlen:
            self.dropped += 1
            if self.dropped >= self._tell_at:
                self._tell_loss()
        items.append(item)
        if not self.ringing:
            self.ringing = True
            bell = self._bell
            bell.rung.append(self)
            if not bell.pending:
                bell.ring()

    def _tell_loss(self) -> None:
        self._tell_at = 2 * self.dropped
        if self._losses is not None:
            self._losses.put(None)


class DeepInbox(Inbox):
    """A long inbox whose bytes are limited as well, to `BYTES_BOUND`.

    The loop takes messages without accounting for them, so the queue is only counted once enough has arrived to
    possibly exceed the limit. Then a quarter is dropped at once, so that counting costs little per message even when it
    is full.
    """

    __slots__ = ("_at_most",)

    def __init__(self, bell: Rings, depth: int, ready: Callable[[], None]) -> None:
        super().__init__(bell, depth, ready)
        self._at_most = 0
        """Upper limit of the queued bytes, assuming that nothing was taken since the last count."""

    def put(self, item: Any) -> None:
        size = size_of(item)
        if self._at_most + size > BYTES_BOUND:
            self._make_room()
        self._at_most += size
        super().put(item)

    def _make_room(self) -> None:
        waiting = sum(map(size_of, tuple(self.items)))
        while waiting > BYTES_BOUND * 3 // 4:
            try:
                waiting -= size_of(self.items.popleft())
            except IndexError:  # the loop has taken them in the meantime
                break
            self.dropped += 1
        self._at_most = waiting
        if self.dropped >= self._tell_at:
            self._tell_loss()


class RequestInbox(Inbox):
    """An inbox of requests: when full, new items are refused, and queued ones stay.

    It is full with `depth` items or `BYTES_BOUND` bytes, and then accepts no more until a quarter has been taken, which
    also limits how often the bytes are counted.

    Args:
        size: Returns the bytes of an item.
        stand_in: Called with a refused item, on any thread; its result is queued instead, unless it is None or there
            are `STAND_INS` times the depth.
    """

    __slots__ = ("_at_most", "_size", "_stand_in", "_takes_at", "depth")

    def __init__(
        self,
        bell: Rings,
        depth: int,
        ready: Callable[[], None],
        size: Callable[[Any], int],
        stand_in: Callable[[Any], Any],
    ) -> None:
        super().__init__(bell, None, ready)
        self.depth = depth
        self._size, self._stand_in = size, stand_in
        self._at_most = 0
        """Upper limit of the queued bytes, assuming that nothing was taken since the last count."""
        self._takes_at = depth - 1
        """Queue length at which items are accepted again."""

    def put(self, item: Any) -> None:
        size = self._size(item)
        number = len(self.items)
        if number > self._takes_at or (self._at_most + size > BYTES_BOUND and not self._has_room(size, number)):
            self._takes_at = min(self._takes_at, number * 3 // 4)
            self.dropped += 1
            if self.dropped >= self._tell_at:
                self._tell_loss()
            item, size = self._stand_in(item) if number < STAND_INS * self.depth else None, 0
            if item is None:
                return
        else:
            self._takes_at = self.depth - 1
        self._at_most += size
        super().put(item)

    def _has_room(self, size: int, number: int) -> bool:
        self._at_most = sum(map(self._size, tuple(self.items)))
        return number == 0 or self._at_most + size <= BYTES_BOUND


def size_of(item: Any) -> int:
    """Return the bytes of an arrival's payload."""
    return len(item.payload)


def open_inbox(qos: Qos, bell: Rings, ready: Callable[[], None]) -> Inbox:
    """Return the inbox for a subscription."""
    bound = KEEP_ALL_BOUND if qos.history is History.KEEP_ALL else qos.depth
    return DeepInbox(bell, bound, ready) if bound > DEEP else Inbox(bell, bound, ready)


def request_size(request: Request) -> int:
    """Return the bytes of a request's payload."""
    return request.size
