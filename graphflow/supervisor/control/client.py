"""The blocking side of the control socket, for verbs: without asyncio, whose import would slow short commands."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from typing import Any, Self, TypeAlias

from graphflow.errors import SupervisorError

Event: TypeAlias = dict[str, Any]
"""A line from a supervisor, one of the types in `messages`, tagged by `event`."""
CONNECT_LIMIT = 5.0
"""Seconds for a connection, and by default for each event."""
TCP = "tcp/"
"""Prefix of the address of a supervisor on loopback, the portable way."""


def connect(address: str) -> tuple[socket.socket, dict[str, str]]:
    """Connect to a supervisor; returns the connection and the fields that every request must carry."""
    if address.startswith(TCP):
        port, _, token = address.removeprefix(TCP).partition("/")
        return socket.create_connection(("127.0.0.1", int(port)), CONNECT_LIMIT), {"token": token}
    connection = socket.socket(socket.AF_UNIX)
    connection.settimeout(CONNECT_LIMIT)
    try:
        connection.connect(address)
    except OSError:
        connection.close()
        raise
    return connection, {}


class ControlClient:
    """A connection of a client; blocking.

    Raises:
        SupervisorError: Nothing answers at the address.
    """

    def __init__(self, address: str) -> None:
        try:
            self._socket, self._token = connect(address)
        except OSError as error:
            raise SupervisorError(f"the supervisor at {address} does not answer: {error.strerror}") from None
        self._buffer = b""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def fileno(self) -> int:
        return self._socket.fileno()

    def send(self, **request: object) -> None:
        """Send a request.

        Raises:
            SupervisorError: The supervisor has gone.
        """
        try:
            self._socket.sendall(json.dumps({**request, **self._token}).encode() + b"\n")
        except OSError as error:
            raise SupervisorError(f"the supervisor has gone: {error.strerror}") from None

    def receive(self, timeout: float | None = CONNECT_LIMIT) -> Iterator[Event]:
        """Yield events as they come, until the supervisor closes the connection.

        Args:
            timeout: Seconds between two events; None for no limit.

        Raises:
            SupervisorError: Nothing came in time (exit 4).
        """
        self._socket.settimeout(timeout)
        while True:
            while b"\n" in self._buffer:
                line, _, self._buffer = self._buffer.partition(b"\n")
                yield json.loads(line)
            try:
                data = self._socket.recv(65536)
            except TimeoutError:
                raise SupervisorError("the supervisor does not answer", exit_code=4) from None
            except ConnectionError:
                return
            if not data:
                return
            self._buffer += data

    def pending(self) -> list[Event] | None:
        """Return the events that have arrived; None once the supervisor has closed the connection."""
        self._socket.setblocking(False)
        try:
            while True:
                data = self._socket.recv(65536)
                if not data:
                    return self._lines() or None
                self._buffer += data
        except BlockingIOError:
            return self._lines()
        except ConnectionError:  # events that arrived before it still count
            return self._lines() or None

    def _lines(self) -> list[Event]:
        *lines, self._buffer = self._buffer.split(b"\n")
        return [json.loads(line) for line in lines]
