"""Lines of JSON over a file descriptor, on the supervisor's loop."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import socket
from collections.abc import Callable
from contextlib import suppress
from typing import Any

logger = logging.getLogger("graphflow.supervisor")

READ_SIZE = 1 << 16
"""Bytes read at a time: all that a pipe can hold."""


class Lines:
    """Reads events from a descriptor as they come; writes requests if it is a socket.

    Args:
        heard: Called with each event.
        lost: Called once when the other end has gone.
    """

    def __init__(
        self, channel: socket.socket | int, heard: Callable[[dict[str, Any]], None], lost: Callable[[], None]
    ) -> None:
        self._channel = channel
        self._heard, self._lost = heard, lost
        self._buffer = self._unsent = b""
        self._is_closed = False
        self._fd = channel if isinstance(channel, int) else channel.fileno()
        os.set_blocking(channel, False) if isinstance(channel, int) else channel.setblocking(False)
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(self._fd, self.read)

    def read(self) -> None:
        """Take in what has come, which the loop does by itself sooner or later."""
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
            self._heard(event)

    def send(self, **request: Any) -> None:
        """Send a request, at once or as soon as the other end, which may be stopped, reads on."""
        self._unsent += json.dumps(request).encode() + b"\n"
        self._write()

    def _write(self) -> None:
        assert isinstance(self._channel, socket.socket)
        with suppress(BlockingIOError):
            try:
                self._unsent = self._unsent[self._channel.send(self._unsent) :]
            except ConnectionError:
                self._unsent = b""
                self._loop.call_soon(self._lose)
        if self._unsent:
            self._loop.add_writer(self._fd, self._write)
        else:
            self._loop.remove_writer(self._fd)

    def _lose(self) -> None:
        if not self._is_closed:
            self.close()
            self._lost()

    def close(self) -> None:
        """Stop reading and writing."""
        self._is_closed = True
        self._loop.remove_reader(self._fd)
        self._loop.remove_writer(self._fd)
