"""Lines of JSON over a file descriptor, on the supervisor's loop."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import socket
from collections.abc import Callable
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
        self._buffer = b""
        self._fd = channel if isinstance(channel, int) else channel.fileno()
        os.set_blocking(self._fd, False)
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
            self.close()
            self._lost()
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
        """Send a request; the other end is a process of our own that reads at once."""
        assert isinstance(self._channel, socket.socket)
        self._channel.setblocking(True)
        try:
            self._channel.sendall(json.dumps(request).encode() + b"\n")
        except ConnectionError:
            self._loop.call_soon(self._lost)
        finally:
            self._channel.setblocking(False)

    def close(self) -> None:
        """Stop reading."""
        self._loop.remove_reader(self._fd)
