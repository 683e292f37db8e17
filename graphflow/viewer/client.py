"""One connected viewer and its bounded send queues.

A viewer displays the present, so if it reads too slowly, the newest messages count. Each channel has a short queue of
its own; small messages go first, and channels of large ones take turns. No more is sent than the viewer is known to
read, since messages in the system's buffers can no longer be dropped.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections import deque
from collections.abc import Awaitable, Callable

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from graphflow.errors import GraphflowError, printable
from graphflow.viewer.protocol import control_message

logger = logging.getLogger("graphflow")

Connections = dict[str, dict[str, list[str]]]
"""The nodes of each topic or service, by part of the connection graph."""

CHANNEL_BOUND = 64 << 10
"""Maximum bytes waiting in a channel; of larger messages, only the latest is kept."""
CHANNEL_DEPTH = 100
"""Maximum messages waiting in a channel."""
WINDOW = 256 << 10
"""Bytes of messages between two pings, which confirm that the viewer has read them."""
WINDOWS = 2
"""Maximum unanswered pings before sending pauses."""
CONTROL_BOUND = 16 << 20
"""Maximum bytes of control messages waiting; a viewer that exceeds it is disconnected."""
TEXT_BOUND = 500
"""Maximum characters of a warning, which may quote the viewer's own input."""
WORK_BOUND = 100
"""Maximum calls and parameter requests under way."""


class Client:
    """A connected viewer."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection
        self._control: deque[str | bytes] = deque()
        self._waiting: dict[int, deque[bytes]] = {}
        """Messages waiting by channel, without empty queues."""
        self._turns = itertools.count(1)
        self._sent_at: dict[int, int] = {}
        """The turn in which each channel last sent."""
        self._control_bytes = self._sent = self._unread = 0
        """Bytes of control messages waiting; bytes of messages sent since the last ping; unanswered pings."""
        self._is_new = asyncio.Event()
        self._is_drained = asyncio.Event()
        self.one_file = asyncio.Lock()
        """Held while a file is read and sent."""
        self._work: set[asyncio.Task[None]] = set()
        self.dropped = 0
        """Messages dropped because the client reads too slowly."""
        self.followed: set[str] = set()
        """Parameters whose changes the client follows."""
        self.follows_all = False
        """Whether the client follows the changes of all parameters."""
        self.graph: Connections | None = None
        """The connection graph last sent; None if the client does not follow it."""

    def send_control(self, message: str | bytes) -> None:
        """Send a control message ahead of all other messages; disconnect a client that does not read."""
        self._control.append(message)
        self._control_bytes += len(message)
        self._is_drained.clear()
        if self._control_bytes > CONTROL_BOUND:
            logger.warning("a viewer reads too slowly and is disconnected")
            self._control.clear()
            self.abort()
        self._is_new.set()

    async def drained(self) -> None:
        """Wait until all control messages are sent."""
        await self._is_drained.wait()

    def abort(self) -> None:
        """Drop the connection without a closing handshake."""
        self._connection.transport.abort()

    def warn(self, text: str) -> None:
        """Send a warning to be displayed."""
        self.send_control(control_message("status", level=1, message=printable(text[:TEXT_BOUND])))

    def send_message(self, channel: int, frame: bytes) -> None:
        """Queue a message of a channel."""
        waiting = self._waiting.setdefault(channel, deque())
        waiting.append(frame)
        while len(waiting) > 1 and (len(waiting) > CHANNEL_DEPTH or sum(map(len, waiting)) > CHANNEL_BOUND):
            waiting.popleft()
            if not self.dropped:
                self.warn("this viewer reads too slowly: the oldest messages are dropped")
            self.dropped += 1
        self._is_new.set()

    def spawn(self, work: Callable[[], Awaitable[None]]) -> None:
        """Run a slow request in a task; report its errors to the client."""
        if len(self._work) >= WORK_BOUND:
            self.warn(f"{WORK_BOUND} requests are under way already")
            return
        task = asyncio.ensure_future(self._run(work))
        self._work.add(task)
        task.add_done_callback(self._work.discard)

    async def _run(self, work: Callable[[], Awaitable[None]]) -> None:
        try:
            await work()
        except GraphflowError as error:
            self.warn(str(error))
        except Exception as error:  # the client's input may cause any error
            logger.warning("a viewer's request failed", exc_info=error)
            self.warn(f"this request failed: {error!r}")

    async def write(self) -> None:
        """Send queued messages until the connection ends."""
        try:
            while True:
                if self._control:
                    message = self._control.popleft()
                    self._control_bytes -= len(message)
                    await self._connection.send(message)
                    if not self._control:
                        self._is_drained.set()
                elif self._waiting and self._unread < WINDOWS:
                    await self._send(self._next())
                else:
                    self._is_new.clear()
                    await self._is_new.wait()
        except ConnectionClosed:
            return

    def _next(self) -> bytes:
        """Choose the next message: the smallest of the small ones, otherwise a large one, in turn by channel."""
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
            pong = await self._connection.ping()  # sends now; the future is done with the reply
            asyncio.ensure_future(pong).add_done_callback(self._ponged)

    def _ponged(self, pong: asyncio.Future[float]) -> None:
        """Handle a pong: the client has read everything before the ping, or has disconnected."""
        if not pong.cancelled():
            pong.exception()  # a lost connection is reported by the next send
        self._unread -= 1
        self._is_new.set()

    def forget(self, channel: int) -> None:
        """Drop the queue of a channel."""
        self._waiting.pop(channel, None)
        self._sent_at.pop(channel, None)

    def close(self) -> None:
        """Cancel all requests under way."""
        if self.dropped:
            logger.warning("a viewer that has left read too slowly: %s messages were dropped", self.dropped)
        for task in self._work:
            task.cancel()
