"""Messages that publishers keep for those who come later: Zenoh's advanced publishers and subscribers."""

from __future__ import annotations

import asyncio
import logging
from asyncio import AbstractEventLoop
from collections.abc import Callable
from typing import Any

import zenoh

from graphflow.transport.base import Closable, Inbox

logger = logging.getLogger("graphflow.transport")

ASK_AGAIN = (0.5, 2.0)
"""Seconds from the sign of life of a publisher that keeps messages until it is asked for them again."""

Watch = Callable[[str, Callable[[str, bool], None]], Closable]
"""Calls back for the tokens on a key."""


def load_ext() -> Any:
    """Advanced pub/sub; only TRANSIENT_LOCAL endpoints need it."""
    import zenoh.ext

    return zenoh.ext


class AskingAgain:
    """Asks publishers that have appeared for what they keep, a second and a third time.

    The subscriber asks once, at the sign of life. Across routers that may come before there is a route to the
    publisher, and the query ends at once, unanswered: after an outage, what was sent meanwhile would be lost.
    A heartbeat that only this session hears makes the subscriber look for whatever it has missed.
    """

    def __init__(self, raw: zenoh.Session, loop: AbstractEventLoop, watch: Watch, key: str, inbox: Inbox) -> None:
        self._raw, self._loop, self._inbox = raw, loop, inbox
        self._last: dict[str, int] = {}
        """The last sequence number heard, by publisher."""
        self._timers: set[asyncio.TimerHandle] = set()
        self._signs = watch(f"{key}/@adv/pub/**", self._changed)

    def heard(self, sample: zenoh.Sample) -> None:
        """A message has come. Runs on Zenoh's thread."""
        source = sample.source_info
        if source is not None:
            self._last[f"{source.source_id.zid}/{source.source_id.eid}"] = source.source_sn
        self._inbox.put(sample)

    def _changed(self, token: str, is_there: bool) -> None:
        if is_there:
            self._timers = {timer for timer in self._timers if timer.when() > self._loop.time()}
            self._timers |= {self._loop.call_later(after, self._ask, token) for after in ASK_AGAIN}

    def _ask(self, token: str) -> None:
        publisher = "/".join(token.split("/")[-3:-1])
        # Numbers wrap around, and half are ahead: this one surely is, so the publisher answers with what it has.
        ahead = (self._last.get(publisher, 0) + (1 << 30)) % (1 << 32)
        try:
            self._raw.put(token, ahead.to_bytes(4, "little"), allowed_destination=zenoh.Locality.SESSION_LOCAL)
        except zenoh.ZError as error:  # the session is already closed
            logger.debug("asking again: %s", error)

    def undeclare(self) -> None:
        for timer in self._timers:
            timer.cancel()
        self._signs.close()
