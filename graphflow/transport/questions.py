"""Questions that anybody may ask a process: taken one after the other on a thread of their own, and not all of a flood.

As a rule a callback hands them to that thread, which sleeps until one comes. A callback needs the GIL, and twenty
thousand questions a second would leave nothing of it to the nodes. So after the first flood they wait in a ring: Zenoh
keeps the latest and ends the others without an answer, all without Python. It is not there from the beginning, since a
thread that waits for a ring wakes ten times a second (`CHECK_SIGNALS_INTERVAL` in zenoh-python's handlers.rs).
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
"""Questions that wait when the first flood begins; more are ended without an answer."""
BOUND = 256
"""Questions that wait in the ring."""
PAUSE = 0.002
"""Seconds from one question to the next."""
logger = logging.getLogger("graphflow.transport")


class Questions:
    """A queryable for questions, until undeclared.

    Args:
        take: Answers a question, on a thread; the question ends when nobody refers to it any more.
        complete: Whether it answers for all of `key`.
    """

    def __init__(
        self, session: zenoh.Session, key: str, take: Callable[[zenoh.Query], None], *, complete: bool = False
    ) -> None:
        self._session, self._key, self._take, self._complete = session, key, take, complete
        self._waiting: SimpleQueue[zenoh.Query | None] = SimpleQueue()
        """None is the last: the callback is undeclared, or the session closed."""
        self._is_flooded = self._is_closed = False
        self._ring: Any = None
        self._declaring = threading.Lock()
        """Held while it is decided which queryable there is."""
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
            del query  # which ends it, if nobody keeps it to answer it later
            if self._is_flooded and self._ring is None:
                self._change_over()
            time.sleep(PAUSE)
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
        except Exception as error:  # a question that fails must not end the answers to others
            logger.debug("a question cannot be answered", exc_info=error)

    def _change_over(self) -> None:
        """Put a ring in the callback's place, for good. Meanwhile there are both, so that every question is heard."""
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
        """Take no more questions.

        Raises:
            ZError: The session is already closed.
        """
        with self._declaring:
            self._is_closed = True
            self._queryable.undeclare()
