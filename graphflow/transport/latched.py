"""Messages kept for late subscribers (TRANSIENT_LOCAL), by Zenoh's advanced publishers and subscribers."""

from __future__ import annotations

import asyncio
import logging
from asyncio import AbstractEventLoop
from collections.abc import Callable
from typing import Any

import zenoh

from graphflow.transport.base import Closable
from graphflow.transport.inbox import Inbox

logger = logging.getLogger("graphflow.transport")

ASK_AGAIN = (0.5, 2.0)
"""Seconds from the appearance of a publisher that keeps messages to each repeated query."""

Watch = Callable[[str, Callable[[str, bool], None]], Closable]
"""Calls back for the tokens on a key."""


def load_ext() -> Any:
    """Return the advanced pub/sub module, which only TRANSIENT_LOCAL endpoints need."""
    import zenoh.ext

    return zenoh.ext


class AskingAgain:
    """Repeated queries to new publishers for the messages they keep.

    Zenoh's subscriber queries a publisher once, when its token appears. Across routers there may be no route to it yet,
    and the query ends at once without a reply: messages sent during an outage would be lost. A heartbeat that only this
    session receives makes the subscriber query again.
    """

    def __init__(self, raw: zenoh.Session, loop: AbstractEventLoop, watch: Watch, key: str, inbox: Inbox) -> None:
        self._raw, self._loop, self._inbox = raw, loop, inbox
        self._last: dict[str, int] = {}
        """The last sequence number received, by publisher."""
        self._timers: set[asyncio.TimerHandle] = set()
        self._signs = watch(f"{key}/@adv/pub/**", self._changed)

    def heard(self, sample: zenoh.Sample) -> None:
        """Note a message. Runs on Zenoh's thread."""
        source = sample.source_info
        if source is not None:
            self._last[f"{source.source_id.zid}/{source.source_id.eid}"] = source.source_sn
        self._inbox.put(sample)

    def _changed(self, token: str, is_there: bool) -> None:
        if is_there:
            self._timers = {timer for timer in self._timers if timer.when() > self._loop.time()}
            self._timers |= {self._loop.call_later(after, self._ask, token) for after in ASK_AGAIN}

    def _ask(self, token: str) -> None:
        # The token is `<key>/@adv/pub/<zid>/<eid>/_`, and a heartbeat a publication on it: the last sequence number as
        # a uint32, little-endian (zenoh-ext, advanced_publisher.rs).
        publisher = "/".join(token.split("/")[-3:-1])
        # Sequence numbers wrap around and half count as ahead: this one does, so the publisher replies with all it has.
        ahead = (self._last.get(publisher, 0) + (1 << 30)) % (1 << 32)
        try:
            self._raw.put(token, ahead.to_bytes(4, "little"), allowed_destination=zenoh.Locality.SESSION_LOCAL)
        except zenoh.ZError as error:  # the session is already closed
            logger.debug("asking again: %s", error)

    def undeclare(self) -> None:
        for timer in self._timers:
            timer.cancel()
        self._signs.close()
