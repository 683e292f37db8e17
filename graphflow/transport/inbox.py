"""The queues between foreign threads and the event loop.

All arrivals take one path: the network's thread appends them to a bounded `Inbox` and rings the `Bell` unless it is
ringing already; the loop empties the inbox. Payloads stay in the network's form until a handler is about to run, so
that a message dropped from a full inbox has cost nothing.
"""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from graphflow.qos import History, Qos
from graphflow.system import is_portable

if TYPE_CHECKING:
    from asyncio import AbstractEventLoop

KEEP_ALL_BOUND = 10_000
"""Queue length of a KEEP_ALL subscription."""
WEIGHED = 10
"""Queue length from which the bytes are limited, too."""
DEEP = 100
"""Queue length from which messages are also copied out of the network's buffers."""
BYTES_BOUND = 256 << 20
"""Most bytes of messages in a weighed queue, or of requests in a queue."""
REQUESTS_BOUND = 10_000
"""Most requests that wait for the loop."""
STAND_INS = 10
"""Limit of refused items kept for a response, as a multiple of the queue's depth."""


class Wakeup(Protocol):
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
        # Level-triggered in this case: unread, it would wake the loop again and again.
        os.eventfd_read(self._fd)
        self._attend()

    def _attend(self) -> None:
        # Before `rung` is read, so that an inbox that is added from now on wakes the loop again.
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

    def __init__(self, bell: Wakeup, depth: int | None, ready: Callable[[], None]) -> None:
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
            # Before `pending` is read, the reverse of `_attend`: so no inbox is left without a wake-up.
            bell.rung.append(self)
            if not bell.pending:
                bell.ring()

    def _tell_loss(self) -> None:
        self._tell_at = 2 * self.dropped
        if self._losses is not None:
            self._losses.put(None)


class WeighedInbox(Inbox):
    """An inbox whose bytes are limited as well, to `BYTES_BOUND`.

    The loop takes messages without accounting for them, so the queue is only counted once enough has arrived to
    possibly exceed the limit. Then a quarter is dropped at once, so that counting costs little per message even when it
    is full.
    """

    __slots__ = ("_at_most",)

    def __init__(self, bell: Wakeup, depth: int, ready: Callable[[], None]) -> None:
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
        # `tuple` copies the deque in one step: an iteration would fail if the loop took an item meanwhile.
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


class DeepInbox(WeighedInbox):
    """A weighed inbox for many messages: each loss matters, and they must not hold the network's buffers."""

    __slots__ = ()


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
        bell: Wakeup,
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
        # A request above the limit is accepted alone, or it could never be.
        return number == 0 or self._at_most + size <= BYTES_BOUND


def size_of(item: Any) -> int:
    """Return the bytes of an arrival's payload."""
    return len(item.payload)


def open_inbox(qos: Qos, bell: Wakeup, ready: Callable[[], None]) -> Inbox:
    """Return the inbox for a subscription."""
    bound = KEEP_ALL_BOUND if qos.history is History.KEEP_ALL else qos.depth
    kind = Inbox if bound <= WEIGHED else WeighedInbox if bound <= DEEP else DeepInbox
    return kind(bell, bound, ready)
