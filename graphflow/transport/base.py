"""The runtime's interface to a network, as small protocols; `zenoh` and `memory` implement them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Protocol

from graphflow.qos import Qos
from graphflow.transport.inbox import Bell, Inbox

Payload = bytes | bytearray | memoryview
EARLY = 0.1
"""Seconds after which incomplete reports are passed on."""


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


def request_size(request: Request) -> int:
    """Return the bytes of a request's payload."""
    return request.size
