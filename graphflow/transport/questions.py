"""Queryables that other processes may query freely: handled one at a time on a thread, and limited in a flood.

At first a callback passes queries to that thread, which sleeps until one arrives. A callback needs the GIL, and twenty
thousand queries a second would leave the nodes without it. So after the first flood, queries wait in a ring channel:
Zenoh keeps the latest and ends the others without a reply, all without Python. It is not used from the start, since a
thread that waits on it wakes ten times a second (`CHECK_SIGNALS_INTERVAL` in zenoh-python's handlers.rs).
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from queue import SimpleQueue
from typing import Any

import zenoh
from zenoh.handlers import RingChannel

from graphflow.transport.config import ANSWERING
from graphflow.transport.event_loop.foreign_threads import at_once

FLOOD = 100
"""Waiting queries that count as a flood; further ones end without a reply."""
BOUND = 256
"""Queries kept in the ring channel."""
PAUSE = 0.002
"""Seconds from one query to the next."""
logger = logging.getLogger("graphflow.transport")


class Questions:
    """A queryable, until undeclared.

    Args:
        take: Answers a query, on a thread; the query ends when the last reference to it is dropped.
        complete: Whether the queryable covers all of `key`.
    """

    def __init__(
        self, session: zenoh.Session, key: str, take: Callable[[zenoh.Query], None], *, complete: bool = False
    ) -> None:
        self._session, self._key, self._take, self._complete = session, key, take, complete
        self._waiting: SimpleQueue[zenoh.Query | None] = SimpleQueue()
        """Queries to answer; None ends the thread: the callback is undeclared, or the session closed."""
        self._is_flooded = self._is_closed = False
        self._ring: Any = None
        self._declaring = threading.Lock()
        """Locked while the queryable is replaced."""
        self._queryable = self._declare(at_once(self._heard, lambda: self._waiting.put(None)))
        threading.Thread(target=self._take_turns, name=ANSWERING).start()

    def _declare(self, handler: Any) -> Any:
        return self._session.declare_queryable(self._key, handler, complete=self._complete)

    def _heard(self, query: zenoh.Query) -> None:
        if self._waiting.qsize() < FLOOD:
            self._waiting.put(query)
        else:
            self._is_flooded = True

    def _take_turns(self) -> None:
        while (query := self._waiting.get()) is not None:
            self._answer(query)
            del query  # this ends it, unless a reference is kept to answer it later
            if self._is_flooded and self._ring is None:
                self._change_over()
            time.sleep(PAUSE)
        # The former callback's end, by the change-over, has ended the loop above.
        while self._ring is not None:
            try:
                query = self._ring.recv()
            except zenoh.ZError:  # it was undeclared, or the session closed
                return
            self._answer(query)
            del query
            time.sleep(PAUSE)

    def _answer(self, query: zenoh.Query) -> None:
        try:
            self._take(query)
        except Exception as error:  # a failing query must not end the answers to others
            logger.debug("a question cannot be answered", exc_info=error)

    def _change_over(self) -> None:
        """Replace the callback by a ring channel, for good. Both exist meanwhile, so that no query is missed."""
        with self._declaring:
            if self._is_closed:
                return
            try:
                before, self._queryable = self._queryable, self._declare(RingChannel(BOUND))
                self._ring = self._queryable.handler
                before.undeclare()
            except zenoh.ZError as error:  # the session is already closed
                logger.debug("a ring for questions: %s", error)

    def undeclare(self) -> None:
        """Stop answering.

        Raises:
            ZError: The session is already closed.
        """
        with self._declaring:
            self._is_closed = True
            self._queryable.undeclare()
