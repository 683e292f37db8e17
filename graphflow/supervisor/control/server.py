"""The control socket: lines of JSON between a supervisor and its clients.

Its address is the path of a Unix socket or, the portable way, `tcp/PORT/TOKEN` on loopback: what can read the run file
knows the token, and every request carries it.

A client sends one request and reads lines until the supervisor closes the connection:

    {"do": "ps"}                        -> {"event": "ps", "nodes": [...], "consoles": [...]}
    {"do": "hello"}                     -> {"event": "hello", ...}: the graph, its file, the windows kept with the run
    {"do": "plan"}                      -> {"event": "plan", "plan": ...}: what the graph file says, as `Plan.to_json`
    {"do": "down", "now": false, "reason": text}    -> events until the end, the last {"event": "end", "exit_code": n}
    {"do": "restart", "node": name}     -> {"event": "done"}, or {"event": "error", "message": text}
                                           likewise "start", "stop"; with "threads": [handlers that then run in some]
    {"do": "load", "container": process, "node": {...}}    -> {"event": "loaded", "number": n, "node": name}
    {"do": "unload", "container": process, "number": n}    -> the same: a node that has left the process
    {"do": "follow"}                    -> {"event": "hello", ...}, what has happened so far, then events as they come

A `follow` with `"console": name` counts as a console. Whoever follows may send more requests: these, `announce` and
`keep_layout`.
A client that does not read what it is sent is cut off, so that nothing piles up here.
"""

from __future__ import annotations

import asyncio
import hmac
import json
import os
import secrets
import socket
import struct
from collections.abc import AsyncIterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, Self

from graphflow.errors import GraphflowError, SupervisorError
from graphflow.graph.plan import Plan, node_from_json
from graphflow.supervisor.control.client import TCP, connect
from graphflow.supervisor.control.clients import Clients
from graphflow.supervisor.control.components import Components
from graphflow.system import is_portable, user_id

CLOSE_LIMIT = 1.0
FOLLOW_LIMIT = 5.0
UNREAD_LIMIT = 1 << 20
"""Bytes that may wait for a client that does not read."""
REASON_BOUND = 200
"""Characters of why a graph is stopped."""


class Commands(Protocol):
    """What a client may ask of a supervisor over the socket."""

    def describe(self) -> list[dict[str, Any]]: ...

    @property
    def plan(self) -> Plan: ...

    def hello(self) -> dict[str, Any]: ...

    def begin_stop(self, *, now: bool, reason: str) -> None: ...

    def restart(self, node: str, by: str, *, only_ended: bool = False, threads: Sequence[str] = ()) -> None: ...

    def stop(self, node: str, by: str) -> None: ...

    @property
    def components(self) -> Components: ...

    @property
    def clients(self) -> Clients: ...


class ControlServer:
    """The supervisor's side."""

    def __init__(self, commands: Commands) -> None:
        self._commands = commands
        self._server: asyncio.Server | None = None
        self._token = ""
        self._followed = asyncio.Event()
        self._connections: dict[asyncio.Task[None], asyncio.StreamWriter] = {}

    async def open(self, path: Path) -> str:
        """Listen, for this user only; returns the address.

        Args:
            path: Where a Unix socket goes.
        """
        if is_portable():
            self._token = secrets.token_hex(16)
            self._server = await asyncio.start_server(self._accept, "127.0.0.1", 0)
            return f"{TCP}{self._server.sockets[0].getsockname()[1]}/{self._token}"
        if self._server is not None:
            self._server.close()
        path.unlink(missing_ok=True)
        mask = os.umask(0o177)
        try:
            self._server = await asyncio.start_unix_server(self._accept, path)
        finally:
            os.umask(mask)
        return str(path)

    async def wait_followed(self) -> None:
        """Wait for a client to follow the graph, but not for long: one that fails at once can still say why."""
        try:
            async with asyncio.timeout(FOLLOW_LIMIT):
                await self._followed.wait()
        except TimeoutError:
            return

    def expect_nobody(self) -> None:
        """The command that started the graph has gone: no client will come to hear how it ends."""
        self._followed.set()

    async def close(self) -> None:
        """Stop listening, and let open connections send what is waiting."""
        if self._server is not None:
            self._server.close()
        for writer in self._connections.values():
            writer.close()
        if self._connections:
            await asyncio.wait(self._connections, timeout=CLOSE_LIMIT)

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        self._connections[task] = writer
        try:
            if self._token or _peer_uid(writer.get_extra_info("socket")) in (None, user_id()):
                await self._serve(reader, writer)
        except (ConnectionError, asyncio.IncompleteReadError, ValueError):
            return
        finally:
            del self._connections[task]
            writer.close()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            request = json.loads(await reader.readline())
            what = request["do"]
            if not hmac.compare_digest(str(request.get("token", "")), self._token):
                return
        except (ValueError, KeyError, TypeError):
            _write(writer, {"event": "error", "message": "not a request"})
            return
        if what == "down":
            await self._down(writer, now=bool(request.get("now")), reason=_reason(request))
        elif what == "follow":
            await self._follow(reader, writer, request)
        elif what in ("load", "unload"):
            _write(writer, await self._compose(request))
        else:
            _write(writer, self._do(request))
        await writer.drain()

    async def _compose(self, request: dict[str, Any]) -> dict[str, Any]:
        """Load a node into a process, or unload one; returns the answer."""
        components, container = self._commands.components, str(request.get("container"))
        try:
            if request["do"] == "load":
                number, node = await components.load(container, node_from_json(request["node"]))
            else:
                number = int(request["number"])
                node = await components.unload(container, number)
        except SupervisorError as error:
            return {"event": "error", "message": str(error)}
        except (ValueError, KeyError, TypeError) as error:
            return {"event": "error", "message": f"not a request: {error}"}
        return {"event": "loaded", "number": number, "node": node}

    def _do(self, request: Any) -> dict[str, Any]:
        """Carry out a request that is done at once; returns the answer."""
        if not isinstance(request, dict):
            return {"event": "error", "message": "not a request"}
        what, by = request.get("do"), str(request.get("by", "the command line"))
        try:
            if what == "ps":
                return {"event": "ps", "nodes": self._commands.describe(), "consoles": self._commands.clients.consoles}
            if what == "plan":
                return {"event": "plan", "plan": self._commands.plan.to_json(), "folder": os.getcwd()}
            if what == "hello":
                return self._commands.hello()
            if what == "down":
                self._commands.begin_stop(now=bool(request.get("now")), reason=_reason(request))
            elif what in ("restart", "start"):
                node, threads = str(request.get("node")), [str(name) for name in request.get("threads", ())]
                self._commands.restart(node, by, only_ended=what == "start", threads=threads)
            elif what == "stop":
                self._commands.stop(str(request.get("node")), by)
            elif what == "announce":
                self._commands.clients.announce(str(request.get("text")), by)
            elif what == "keep_layout":
                self._commands.clients.keep_layout(request.get("layout"))
            else:
                return {"event": "error", "message": f"{what!r} is not a request"}
        except (GraphflowError, ValueError, TypeError, RecursionError) as error:
            return {"event": "error", "message": str(error)}
        return {"event": "done", "do": what}

    async def _down(self, writer: asyncio.StreamWriter, *, now: bool, reason: str) -> None:
        ended = asyncio.Event()

        def listener(event: dict[str, Any]) -> None:
            _write(writer, event)
            if event["event"] == "end":
                ended.set()

        clients = self._commands.clients
        stop = clients.subscribe(listener, replay=clients.has_ended)  # one that comes late hears what has happened
        try:
            self._commands.begin_stop(now=now, reason=reason)
            await ended.wait()
        finally:
            stop()

    async def _follow(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, request: dict[str, Any]
    ) -> None:
        clients = self._commands.clients
        _write(writer, self._commands.hello())
        stop = clients.subscribe(lambda event: _write(writer, event), replay=True)
        leave = clients.join(str(request["console"])) if "console" in request else None
        try:
            self._followed.set()
            while line := await reader.readline():
                _write(writer, self._do(json.loads(line)))
        finally:
            # However the connection ended: a peer that dies with unread events resets it.
            stop()
            if leave is not None:
                leave()


def _reason(request: Mapping[str, Any]) -> str:
    return str(request.get("reason", "down"))[:REASON_BOUND]


def _write(writer: asyncio.StreamWriter, event: dict[str, Any]) -> None:
    if writer.transport.get_write_buffer_size() > UNREAD_LIMIT:
        writer.transport.abort()
    if not writer.is_closing():
        writer.write(json.dumps(event).encode() + b"\n")


def _peer_uid(connection: Any) -> int | None:
    """The user at the other end, where the system can tell."""
    if not hasattr(socket, "SO_PEERCRED"):
        return None
    layout = struct.Struct("3i")
    _, uid, _ = layout.unpack(connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, layout.size))
    return int(uid)


class ControlStream:
    """A client's side, for an event loop."""

    def __init__(self, reader: asyncio.StreamReader, writers: Sequence[asyncio.StreamWriter], token: Mapping[str, str]):
        self._reader, self._writers, self._token = reader, writers, token
        self._has_ended = False

    @classmethod
    async def open(cls, address: str, line_limit: int) -> Self:
        """Connect to a supervisor.

        Args:
            line_limit: Bytes that a line may have.

        Raises:
            OSError: Nothing answers at the address.
        """
        connection, token = connect(address)
        # A stream that fails to write reads no more either, and what a supervisor says last would be lost.
        for_writing = connection.dup()
        reader, kept_open = await asyncio.open_connection(sock=connection, limit=line_limit)
        _, writer = await asyncio.open_connection(sock=for_writing)
        writer.transport.pause_reading()  # type: ignore[attr-defined]
        return cls(reader, (writer, kept_open), token)

    def send(self, **request: Any) -> bool:
        """Send a request; returns whether there was anybody to send it to."""
        writer = self._writers[0]
        if self._has_ended or writer.is_closing():
            return False
        writer.write(json.dumps({**request, **self._token}).encode() + b"\n")
        return True

    def end_requests(self) -> None:
        """Say that no more come: once it has read them all, the supervisor closes the connection."""
        self._has_ended = True
        if not self._writers[0].is_closing():
            self._writers[0].write_eof()

    async def receive(self) -> AsyncIterator[dict[str, Any]]:
        """Events as they come, until the supervisor closes the connection.

        Raises:
            OSError: The connection broke.
            ValueError: A line is too long, or no JSON.
        """
        while line := await self._reader.readline():
            yield json.loads(line)

    def close(self) -> None:
        for writer in self._writers:
            writer.close()
