"""What the runtime needs from a network, as small protocols, and the queue by which foreign threads reach the loop.

Everything that arrives takes one path: the network's thread appends it to an `Inbox`, which is bounded, and rings the
`Bell` if it is silent; the loop empties the inbox. Payloads stay as the network delivered them until a handler is about
to run, so that a message dropped from a full inbox has cost nothing.
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
"""Seconds after which the reports so far are passed on although others are missing."""


KEEP_ALL_BOUND = 10_000
"""Messages that a KEEP_ALL subscription holds before it counts losses."""
DEEP = 100
"""Messages of a queue from which on its bytes are bounded, too, and it holds none of the network's buffers."""
BYTES_BOUND = 256 << 20
"""Bytes of messages that wait in a deep queue, or of requests."""
REQUESTS_BOUND = 10_000
"""Requests that wait for the loop."""
STAND_INS = 10
"""How many times that are remembered to be refused."""


class Closable(Protocol):
    """Something declared on the network, until it is closed. Closing twice is harmless."""

    def close(self) -> None: ...


class Sender(Closable, Protocol):
    """A publication on one key."""

    @property
    def is_wanted(self) -> bool:
        """Whether anything sent now would reach a receiver or be kept for one."""

    def put(self, payload: Payload, *, attachment: bytes) -> None:
        """Send without waiting. A receiver that cannot keep up loses messages; the sender is not blocked."""


class Caller(Closable, Protocol):
    """Requests to the servers on one key."""

    def call(
        self, payload: Payload, attachment: bytes, answered: Callable[[Answer | None], None]
    ) -> Callable[[], None]:
        """Send a request.

        Args:
            answered: Called on the loop for each reply, and at the end with None.

        Returns:
            A function that gives up the request; no reply comes after it.
        """

    @property
    def has_server(self) -> bool:
        """Whether the network knows a server that this caller would reach."""


class Answer(NamedTuple):
    """One reply to a call."""

    payload: bytes
    attachment: bytes | None = None
    is_error: bool = False


class Request(Protocol):
    """One request as a server gets it. It must be answered once: until then the caller waits."""

    @property
    def payload(self) -> bytes: ...

    @property
    def size(self) -> int:
        """Bytes of the payload."""

    @property
    def attachment(self) -> bytes | None: ...

    def reply(self, payload: Payload, attachment: bytes) -> None: ...

    def reply_error(self, payload: bytes) -> None: ...


class Arrival(Protocol):
    """One publication as it arrived, not yet copied out of the network's memory."""

    @property
    def payload(self) -> bytes: ...

    @property
    def attachment(self) -> bytes | None: ...


class LargeSender(Closable, Protocol):
    """A publication on one key whose large messages are read from shared memory where all receivers can."""

    in_memory: int
    """Messages that went through memory."""

    @property
    def memory(self) -> int:
        """Bytes of memory that are kept for it."""

    def admit(self, readers: Mapping[tuple[str, int], int] | None) -> None:
        """Tell of the receivers.

        Args:
            readers: The depths of their queues, by session and entity, if all of them read the memory.
        """

    def put_parts(self, parts: tuple[list[Any], int], *, attachment: bytes) -> None:
        """Send what `Codec.encode_parts` returns, without waiting."""

    def lend(self, dtype: Any, count: int) -> Any:
        """An array where the next message's may be, to be filled; None if it would have to be copied. One at a time."""

    def take_back(self) -> None:
        """End the loan."""


class RingReceiver(Closable, Protocol):
    """Where descriptors arrive, in the place of large messages."""

    reader: tuple[int, int]
    """By what others know that this process can read their memory: its id and a file of it."""

    def forget_ended(self) -> None:
        """Give back the memory of senders that have gone."""


class Session(Protocol):
    """One process's place on the network."""

    zid: str
    """The session's id as written in tokens: lower-case hex."""
    bell: Bell
    """Rung by this session's inboxes."""

    def open_sender(
        self, key: str, qos: Qos, changed: Callable[[], None] | None = None, *, only_others: bool = False
    ) -> Sender:
        """Args:
        changed: Called on the loop when `is_wanted` may have changed; not for TRANSIENT_LOCAL ones, whose never does.
        only_others: Whether to leave out receivers of this session; not for TRANSIENT_LOCAL ones.
        """

    def open_receiver(
        self, key: str, qos: Qos, inbox: Inbox, *, ignore_local: bool = False, in_order: bool = False
    ) -> Closable:
        """Put every publication on `key` into `inbox`; `read` opens what is found there.

        Args:
            key: Its last part may be `*`; `key_of` then gives the full key.
            ignore_local: Whether to leave out what this session sends itself.
            in_order: Whether answers that were sent after a publication must not overtake it; for what is not sent
                often. Not for TRANSIENT_LOCAL.
        """

    def open_large_sender(self, sender: Sender, key: str) -> LargeSender | None:
        """Send what is large through shared memory, and the rest by `sender`; None where memory cannot be shared.

        Args:
            key: That of the ring receivers.
        """

    def open_ring_receiver(self, key: str, eid: int, inbox: Inbox) -> RingReceiver | None:
        """Put large messages into the inbox of a receiver that has `in_order`; None where memory cannot be shared.

        Args:
            eid: The subscription's number in its session.
        """

    def is_neighbour(self, zid: str, pid: int, fd: int) -> bool:
        """Whether a session belongs to a process that can read this one's memory, as it says of itself."""

    def open_server(self, key: str, inbox: Inbox, *, is_paced: bool = False) -> Closable:
        """Put every request on `key` into `inbox`, as `Request`s.

        Args:
            is_paced: Whether requests come so quickly only that asking does not hold up the process; of too many, the
                earlier end without an answer. For keys of graphflow's own, on which anybody may ask.
        """

    def open_caller(self, key: str, changed: Callable[[], None]) -> Caller:
        """Args:
        changed: Called on the loop when `has_server` has changed.
        """

    def announce(self, token: str) -> Closable:
        """Declare a liveliness token that lasts until the process ends or the result is closed."""

    def watch(self, key: str, changed: Callable[[str, bool], None]) -> Closable:
        """Call `changed(token, alive)` on the loop for every token that matches, including existing ones."""

    def ask_tokens(self, key: str, limit: float, told: Callable[[list[str]], None]) -> None:
        """Ask for the tokens that match now.

        Args:
            limit: Seconds that they have to arrive; over a network, it takes as long.
            told: Called on the loop, once, with those that arrived.
        """

    def open_report(self, key: str, report: Callable[[], bytes]) -> Closable:
        """Answer queries on `key` with what `report` returns. It is called on a thread of its own, where there
        are threads, so that it answers while the loop is blocked; paced, as for `open_server`.
        """

    def ask_reports(self, key: str, limit: float, told: Callable[[list[bytes], bool], None]) -> None:
        """Ask all reports whose key matches.

        Args:
            limit: Seconds that they have to arrive.
            told: Called on the loop with those that arrived, and whether these are all: once, or also earlier, after
                `EARLY` seconds, when some are still missing by then.
        """

    def read(self, arrival: Any) -> tuple[bytes, bytes | None]:
        """Payload and attachment of something that a receiver put in an inbox.

        A payload in shared memory is no `bytes`, but can be decoded and copied as one.
        """

    def key_of(self, arrival: Any) -> str:
        """The key on which an arrival was published."""

    def leave(self) -> None:
        """Begin to close: what is closed from now on may stay declared until `close`, which withdraws all at once and
        cannot be delayed by peers that are going away too.
        """

    async def close(self) -> None: ...


class Rings(Protocol):
    """What wakes those who empty inboxes: the loop, by a `Bell`, or threads of somebody else's."""

    rung: deque[Inbox]
    """Inboxes that wait to be emptied."""
    pending: bool
    """Whether somebody has been woken for them."""

    def ring(self) -> None:
        """Wake them. Callable from any thread."""


class Bell:
    """Wakes the loop, once per burst.

    Args:
        loop: The loop to wake.
        threads: Whether rings come from other threads than the loop's.
    """

    def __init__(self, loop: AbstractEventLoop, *, threads: bool = True) -> None:
        self._loop = loop
        self.rung: deque[Inbox] = deque()
        """Inboxes that wait to be emptied."""
        self.pending = False
        """Whether the loop has been woken for them."""
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
            inbox.ringing = False  # before the queue is read, so that what arrives now rings again
            try:
                inbox.ready()
            except Exception as error:  # one inbox's failure must not affect the others
                self._loop.call_exception_handler({"message": f"{inbox.ready} failed", "exception": error})

    def close(self) -> None:
        """Stop waking the loop; rings not yet answered are lost."""
        self._closed = True
        if self._fd is not None:
            getattr(self._loop, "take_down_bell", self._loop.remove_reader)(self._fd)
            os.close(self._fd)
            self._fd = None


class Inbox:
    """A bounded queue that a foreign thread fills and the loop empties; when full, the oldest item is dropped.

    Args:
        bell: Wakes the loop, or whoever else empties it.
        depth: Items kept; None for no bound.
        ready: Called by whom the bell wakes when there is something that is not being handled yet.
    """

    __slots__ = ("_bell", "_losses", "_tell_at", "dropped", "items", "ready", "ringing")

    def __init__(self, bell: Rings, depth: int | None, ready: Callable[[], None]) -> None:
        self.items: deque[Any] = deque(maxlen=depth)
        self.ready = ready
        self.dropped = 0
        """Items lost because the queue was full."""
        self.ringing = False
        """Whether the bell has been rung for what is in the queue."""
        self._bell = bell
        self._losses: Inbox | None = None
        """Rings the bell for losses."""
        self._tell_at = sys.maxsize
        """The number of losses that is told next."""

    def tell_losses(self, told: Callable[[], None], first: int) -> None:
        """Have whom the bell wakes call `told` at the `first` loss, and whenever there are twice as many.

        It is the only sign of a queue from which nothing is taken any more; what loses nothing pays nothing for it.
        """
        self._losses, self._tell_at = Inbox(self._bell, 1, told), first

    def put(self, item: Any) -> None:
        """Add an item. Callable from any thread; of losses at the same moment on two, one may not be counted."""
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
    """An inbox for so many messages that their bytes are bounded as well: by `BYTES_BOUND`.

    The loop takes messages without telling, so what waits is counted only when so much has arrived that it may be too
    much. Then a quarter goes at once: counting costs little per message also while the queue is full.
    """

    __slots__ = ("_at_most",)

    def __init__(self, bell: Rings, depth: int, ready: Callable[[], None]) -> None:
        super().__init__(bell, depth, ready)
        self._at_most = 0
        """Bytes that wait if nothing was taken since they were counted."""

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
            except IndexError:  # the loop has taken them meanwhile
                break
            self.dropped += 1
        self._at_most = waiting
        if self.dropped >= self._tell_at:
            self._tell_loss()


class RequestInbox(Inbox):
    """An inbox for work that somebody waits for: when it is full, what comes is refused, and what waits stays.

    It is full with `depth` items or `BYTES_BOUND` bytes, and then takes no more until a quarter has gone. What waits is
    counted no more often than that.

    Args:
        size: The bytes of an item.
        stand_in: Called with what is refused, on any thread; what it returns waits in its place, unless that is None or
            there are `STAND_INS` times the depth.
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
        """Bytes that wait if nothing was taken since they were counted."""
        self._takes_at = depth - 1
        """The number of items at which one more is taken."""

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
    """Bytes of an arrival's payload."""
    return len(item.payload)


def open_inbox(qos: Qos, bell: Rings, ready: Callable[[], None]) -> Inbox:
    """The queue of a subscription."""
    bound = KEEP_ALL_BOUND if qos.history is History.KEEP_ALL else qos.depth
    return DeepInbox(bell, bound, ready) if bound > DEEP else Inbox(bell, bound, ready)


def request_size(request: Request) -> int:
    """Bytes of a request's payload."""
    return request.size
