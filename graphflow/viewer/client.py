"""One viewer that is connected: what waits to be sent to it, within bounds."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import Awaitable, Callable
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from graphflow.errors import GraphflowError, printable
from graphflow.viewer.protocol import told

logger = logging.getLogger("graphflow")

DATA_BOUND = 64 << 20
"""Bytes of messages that may wait; what is older is dropped, as the newest tells more."""
WORDS_BOUND = 16 << 20
"""Bytes of words that may wait; a viewer that reads nothing is sent away."""
TEXT_BOUND = 500
"""Characters of a warning: it may repeat what the viewer sent."""
WORK_BOUND = 100
"""Calls and requests for parameters that may be under way."""


class Client:
    """A viewer that is connected."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection
        self._words: deque[str | bytes] = deque()
        self._data: deque[bytes] = deque()
        self._data_bytes = self._words_bytes = 0
        self._is_new = asyncio.Event()
        self._work: set[asyncio.Task[Any]] = set()
        self.dropped = 0
        """Messages that it read too slowly to get."""
        self.followed: set[str] = set()
        """Parameters whose changes it wants to know."""
        self.follows_all = False
        """Whether it wants to know the changes of all parameters."""
        self.graph: dict[str, Any] | None = None
        """The connections that it knows of; None if it does not want to."""

    def say(self, word: str | bytes) -> None:
        """Tell it something, before all messages that wait; one that does not listen is sent away."""
        self._words.append(word)
        self._words_bytes += len(word)
        if self._words_bytes > WORDS_BOUND:
            logger.warning("a viewer reads too slowly, and is sent away")
            self._words.clear()
            self.abort()
        self._is_new.set()

    def abort(self) -> None:
        """End its connection without waiting for it."""
        self._connection.transport.abort()

    def warn(self, text: str) -> None:
        """Tell it that something cannot be."""
        self.say(told("status", level=1, message=printable(text[:TEXT_BOUND])))

    def show(self, head: bytes, payload: bytes) -> None:
        """Send it a message of a channel."""
        self._data.append(head + payload)
        self._data_bytes += len(head) + len(payload)
        while self._data_bytes > DATA_BOUND and len(self._data) > 1:
            self._data_bytes -= len(self._data.popleft())
            if not self.dropped:
                self.warn("this viewer reads too slowly: the oldest messages are left out")
            self.dropped += 1
        self._is_new.set()

    def begin(self, work: Callable[[], Awaitable[None]]) -> None:
        """Do something for it that takes time; its errors are told it."""
        if len(self._work) >= WORK_BOUND:
            self.warn(f"{WORK_BOUND} requests are under way already")
            return
        task = asyncio.ensure_future(self._done(work))
        self._work.add(task)
        task.add_done_callback(self._work.discard)

    async def _done(self, work: Callable[[], Awaitable[None]]) -> None:
        try:
            await work()
        except GraphflowError as error:
            self.warn(str(error))
        except Exception as error:  # whatever it may have sent
            logger.warning("a request of a viewer has failed", exc_info=error)
            self.warn(f"this request has failed: {error!r}")

    async def write(self) -> None:
        """Send what there is, until it has gone."""
        try:
            while True:
                if self._words:
                    word = self._words.popleft()
                    self._words_bytes -= len(word)
                    await self._connection.send(word)
                elif self._data:
                    frame = self._data.popleft()
                    self._data_bytes -= len(frame)
                    await self._connection.send(frame)
                else:
                    self._is_new.clear()
                    await self._is_new.wait()
        except ConnectionClosed:
            return

    def close(self) -> None:
        """End what is under way for it."""
        if self.dropped:
            logger.warning("a viewer that has gone read too slowly: %s messages were left out", self.dropped)
        for task in self._work:
            task.cancel()
