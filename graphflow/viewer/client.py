"""One viewer that is connected: what waits to be sent to it, within bounds.

A viewer shows what is, so of what it reads too slowly the newest counts. Each channel has a short queue of its own.
Small messages go before large ones, and channels of large ones take turns. No more is sent than the viewer has been
seen to read: what lies in the system's buffers can no longer be left out.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections import deque
from collections.abc import Awaitable, Callable
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from graphflow.errors import GraphflowError, printable
from graphflow.viewer.protocol import told

logger = logging.getLogger("graphflow")

CHANNEL_BOUND = 64 << 10
"""Bytes of messages that may wait in a channel; of larger messages, only the latest does."""
CHANNEL_DEPTH = 100
"""Messages that may."""
WINDOW = 256 << 10
"""Bytes of messages after which a viewer is asked whether it has read them."""
WINDOWS = 2
"""Such questions that may be open before it is sent more."""
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
        self._waiting: dict[int, deque[bytes]] = {}
        """Messages by channel; never empty ones."""
        self._turns = itertools.count(1)
        self._sent_at: dict[int, int] = {}
        """When each channel last had its turn."""
        self._words_bytes = self._sent = self._unread = 0
        """Bytes of words that wait; bytes of messages sent since it was asked; questions that are open."""
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

    def show(self, channel: int, frame: bytes) -> None:
        """Send it a message of a channel."""
        waiting = self._waiting.setdefault(channel, deque())
        waiting.append(frame)
        while len(waiting) > 1 and (len(waiting) > CHANNEL_DEPTH or sum(map(len, waiting)) > CHANNEL_BOUND):
            waiting.popleft()
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
                elif self._waiting and self._unread < WINDOWS:
                    await self._send(self._next())
                else:
                    self._is_new.clear()
                    await self._is_new.wait()
        except ConnectionClosed:
            return

    def _next(self) -> bytes:
        """The message to send: a small one first, the smallest; of large ones, in turn by channel."""
        channel = min(self._waiting, key=self._turn)
        self._sent_at[channel] = next(self._turns)
        frame = self._waiting[channel].popleft()
        if not self._waiting[channel]:
            del self._waiting[channel]
        return frame

    def _turn(self, channel: int) -> tuple[bool, int]:
        size = len(self._waiting[channel][0])
        is_large = size > CHANNEL_BOUND
        return is_large, self._sent_at.get(channel, 0) if is_large else size

    async def _send(self, frame: bytes) -> None:
        await self._connection.send(frame)
        self._sent += len(frame)
        if self._sent >= WINDOW:
            self._sent = 0
            self._unread += 1
            asyncio.ensure_future(await self._connection.ping()).add_done_callback(self._was_read)

    def _was_read(self, pong: asyncio.Future[float]) -> None:
        """It has read what came before a ping, or has gone."""
        if not pong.cancelled():
            pong.exception()  # which is told by whatever is sent next
        self._unread -= 1
        self._is_new.set()

    def forget(self, channel: int) -> None:
        """Send no more of a channel."""
        self._waiting.pop(channel, None)
        self._sent_at.pop(channel, None)

    def close(self) -> None:
        """End what is under way for it."""
        if self.dropped:
            logger.warning("a viewer that has gone read too slowly: %s messages were left out", self.dropped)
        for task in self._work:
            task.cancel()
