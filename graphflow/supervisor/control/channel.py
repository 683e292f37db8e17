"""Lines of JSON over a file descriptor, on the supervisor's loop."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import socket
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Generic, TypeVar

logger = logging.getLogger("graphflow.supervisor")

READ_SIZE = 1 << 16
"""Bytes read at a time: the capacity of a pipe."""
E = TypeVar("E")


class Lines(Generic[E]):
    """A descriptor that events are read from as they come and, if it is a socket, requests are written to.

    Args:
        on_event: Called with each event, of a type that is the other end's promise: it is not checked.
        lost: Called once when the other end has gone.
    """

    def __init__(
        self, channel: socket.socket | int, on_event: Callable[[E], object], lost: Callable[[], object]
    ) -> None:
        self._channel = channel
        self._on_event, self._lost = on_event, lost
        self._buffer = self._unsent = b""
        self._is_closed = False
        self._fd = channel if isinstance(channel, int) else channel.fileno()
        os.set_blocking(channel, False) if isinstance(channel, int) else channel.setblocking(False)
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(self._fd, self.read)

    def read(self) -> None:
        """Take in the events that have arrived; the loop calls this, too."""
        try:
            data = os.read(self._fd, READ_SIZE)
        except BlockingIOError:
            return
        except ConnectionError:
            data = b""
        if not data:
            self._lose()
            return
        *lines, self._buffer = (self._buffer + data).split(b"\n")
        for line in lines:
            try:
                event = json.loads(line)
            except ValueError:
                logger.error("not an event: %r", line[:200])
                continue
            self._on_event(event)

    def send(self, request: Mapping[str, object]) -> None:
        """Send a request, at once or as soon as the other end reads on, which may be stopped."""
        self._unsent += json.dumps(request).encode() + b"\n"
        self._write()

    def _write(self) -> None:
        assert isinstance(self._channel, socket.socket)
        with suppress(BlockingIOError):
            try:
                self._unsent = self._unsent[self._channel.send(self._unsent) :]
            except ConnectionError:
                self._unsent = b""
                self._loop.call_soon(self._lose)  # not within `send`, whose caller does not expect callbacks
        if self._unsent:
            self._loop.add_writer(self._fd, self._write)
        else:
            self._loop.remove_writer(self._fd)

    def _lose(self) -> None:
        if not self._is_closed:
            self.close()
            self._lost()

    def close(self) -> None:
        """Stop reading and writing. The descriptor stays open."""
        self._is_closed = True
        self._loop.remove_reader(self._fd)
        self._loop.remove_writer(self._fd)
