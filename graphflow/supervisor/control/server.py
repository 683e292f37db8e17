"""The control socket: lines of JSON between a supervisor and its clients.

Its address is the path of a Unix socket or, the portable way, `tcp/PORT/TOKEN` on loopback: a process that can read the
run file knows the token, and every request carries it.

A client sends one request and reads lines until the supervisor closes the connection (types: `messages`):

    {"do": "ps"}                        -> {"event": "ps", "nodes": [...], "consoles": [...]}
    {"do": "hello"}                     -> {"event": "hello", ...}: the graph, its file, the layout kept with the run
    {"do": "plan"}                      -> {"event": "plan", "plan": ...}: the graph file as resolved, as `Plan.to_json`
    {"do": "down", "now": false, "reason": text}    -> events until the end, the last {"event": "end", "exit_code": n}
    {"do": "restart", "node": name}     -> {"event": "done"}, or {"event": "error", "message": text}
                                           likewise "start", "stop"; with "threads": [handlers to run in threads]
    {"do": "load", "container": process, "node": {...}}    -> {"event": "loaded", "number": n, "node": name}
    {"do": "unload", "container": process, "number": n}    -> the same, for the node that was unloaded
    {"do": "follow"}                    -> {"event": "hello", ...}, the events so far, then events as they come

A `follow` with `"console": name` attaches a console. A client that follows may send more requests: these, `announce`
and `keep_layout`. A client that does not read its events is disconnected, so that no unbounded buffer grows here.
"""

from __future__ import annotations

import asyncio
import hmac
import json
import os
import secrets
import socket
import struct
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, Self

from graphflow.errors import GraphflowError, SupervisorError
from graphflow.graph.plan import Plan, node_from_json
from graphflow.supervisor.control.client import TCP, connect
from graphflow.supervisor.control.clients import Clients
from graphflow.supervisor.control.components import Components
from graphflow.system import is_portable, user_id

if TYPE_CHECKING:
    from graphflow.supervisor.control.messages import GraphEvent, Hello, NodeRow, Reply

CLOSE_LIMIT = 1.0
"""Seconds that open connections have to send their last events."""
FOLLOW_LIMIT = 5.0
"""Seconds that a graph which has ended waits for a client to follow it."""
UNREAD_LIMIT = 1 << 20
"""Bytes that may be buffered for a client that does not read."""
REASON_BOUND = 200
"""Characters of the reason for a stop; the rest is cut."""


class Commands(Protocol):
    """The part of a supervisor that clients may use over the socket."""

    def describe(self) -> list[NodeRow]: ...

    @property
    def plan(self) -> Plan: ...

    def hello(self) -> Hello: ...

    def begin_stop(self, *, now: bool, reason: str) -> None: ...

    def restart(self, node: str, by: str, *, only_ended: bool = False, threads: Sequence[str] = ()) -> None: ...

    def stop(self, node: str, by: str) -> None: ...

    @property
    def components(self) -> Components: ...

    @property
    def clients(self) -> Clients: ...


@dataclass(frozen=True, slots=True)
class _Request:
    """A request of a client, with defaults for the fields it left out."""

    do: object
    token: str
    by: str
    """Name of the client, for announcements."""
    now: bool
    reason: str
    node: object
    """A name or, to load one, its description."""
    threads: tuple[str, ...]
    text: str
    layout: object
    console: str | None
    container: str
    number: object

    @classmethod
    def parse(cls, line: bytes) -> Self:
        """Read a request.

        Raises:
            ValueError: The line is no JSON object, or a field has the wrong type.
        """
        data = json.loads(line)
        if not isinstance(data, dict) or "do" not in data:
            raise ValueError("not a request")
        threads = data.get("threads", ())
        if not isinstance(threads, (list, tuple)):
            raise ValueError("threads: not a list")
        return cls(
            do=data.get("do"),
            token=str(data.get("token", "")),
            by=str(data.get("by", "the command line")),
            now=bool(data.get("now")),
            reason=str(data.get("reason", "down"))[:REASON_BOUND],
            node=data.get("node"),
            threads=tuple(map(str, threads)),
            text=str(data.get("text")),
            layout=data.get("layout"),
            console=str(data["console"]) if "console" in data else None,
            container=str(data.get("container")),
            number=data.get("number"),
        )


class ControlServer:
    """The supervisor's side."""

    def __init__(self, commands: Commands) -> None:
        self._commands = commands
        self._actions: dict[object, Callable[[_Request], Reply | None]] = {
            "ps": self._list_nodes,
            "plan": self._show_plan,
            "hello": lambda _: commands.hello(),
            "down": lambda request: commands.begin_stop(now=request.now, reason=request.reason),
            "restart": self._restart,
            "start": self._restart,
            "stop": lambda request: commands.stop(str(request.node), request.by),
            "announce": lambda request: commands.clients.announce(request.text, request.by),
            "keep_layout": lambda request: commands.clients.keep_layout(request.layout),
        }
        """Requests that are carried out at once; None means that the reply is `done`."""
        self._server: asyncio.Server | None = None
        self._token = ""
        self._followed = asyncio.Event()
        self._connections: dict[asyncio.Task[None], asyncio.StreamWriter] = {}

    async def open(self, path: Path) -> str:
        """Listen, for this user only; returns the address.

        Args:
            path: The path of a Unix socket.
        """
        if is_portable():
            self._token = secrets.token_hex(16)
            self._server = await asyncio.start_server(self._accept, "127.0.0.1", 0)
            return f"{TCP}{self._server.sockets[0].getsockname()[1]}/{self._token}"
        if self._server is not None:
            self._server.close()
        path.unlink(missing_ok=True)
        # By the mask, since a chmod would come too late: others could connect in between.
        mask = os.umask(0o177)
        try:
            self._server = await asyncio.start_unix_server(self._accept, path)
        finally:
            os.umask(mask)
        return str(path)

    async def wait_followed(self) -> None:
        """Wait for a client to follow the graph, but not for long: so `up` learns why a graph failed at once."""
        try:
            async with asyncio.timeout(FOLLOW_LIMIT):
                await self._followed.wait()
        except TimeoutError:
            return

    def expect_nobody(self) -> None:
        """Do not wait for a client: the command that started the graph has ended."""
        self._followed.set()

    async def close(self) -> None:
        """Stop listening, and let open connections send the rest of their events."""
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
            # With a token, each request decides; a Unix socket names the user at its other end.
            if self._token or _peer_uid(writer.get_extra_info("socket")) in (None, user_id()):
                await self._serve(reader, writer)
        except (ConnectionError, asyncio.IncompleteReadError, ValueError):
            return
        finally:
            del self._connections[task]
            writer.close()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        line = await reader.readline()
        try:
            request = _Request.parse(line)
        except (ValueError, RecursionError):
            _write(writer, {"event": "error", "message": "not a request"})
            return
        if not hmac.compare_digest(request.token.encode(), self._token.encode()):
            return
        if request.do == "down":
            await self._down(writer, now=request.now, reason=request.reason)
        elif request.do == "follow":
            await self._follow(reader, writer, request)
        elif request.do in ("load", "unload"):
            _write(writer, await self._compose(request))
        else:
            _write(writer, self._reply(request))
        await writer.drain()

    async def _compose(self, request: _Request) -> Reply:
        """Load a node into a process, or unload one."""
        components = self._commands.components
        try:
            if request.do == "load":
                number, node = await components.load(request.container, node_from_json(_object(request.node)))
            else:
                number = int(str(request.number))
                node = await components.unload(request.container, number)
        except SupervisorError as error:
            return {"event": "error", "message": str(error)}
        except (ValueError, KeyError, TypeError) as error:
            return {"event": "error", "message": f"not a request: {error}"}
        return {"event": "loaded", "number": number, "node": node}

    def _reply(self, request: _Request) -> Reply:
        """Carry out a request that takes no time."""
        action = self._actions.get(request.do) if isinstance(request.do, str) else None
        if action is None:
            return {"event": "error", "message": f"{request.do!r} is not a request"}
        try:
            reply = action(request)
        except (GraphflowError, ValueError, TypeError, RecursionError) as error:
            return {"event": "error", "message": str(error)}
        return reply or {"event": "done", "do": str(request.do)}

    def _list_nodes(self, request: _Request) -> Reply:
        return {"event": "ps", "nodes": self._commands.describe(), "consoles": self._commands.clients.consoles}

    def _show_plan(self, request: _Request) -> Reply:
        return {"event": "plan", "plan": self._commands.plan.to_json(), "folder": os.getcwd()}

    def _restart(self, request: _Request) -> None:
        only_ended = request.do == "start"
        self._commands.restart(str(request.node), request.by, only_ended=only_ended, threads=request.threads)

    async def _down(self, writer: asyncio.StreamWriter, *, now: bool, reason: str) -> None:
        ended = asyncio.Event()

        def listener(event: GraphEvent) -> None:
            _write(writer, event)
            if event["event"] == "end":
                ended.set()

        clients = self._commands.clients
        stop = clients.subscribe(listener, replay=clients.has_ended)  # a late client still gets `end`
        try:
            self._commands.begin_stop(now=now, reason=reason)
            await ended.wait()
        finally:
            stop()

    async def _follow(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, request: _Request) -> None:
        clients = self._commands.clients
        _write(writer, self._commands.hello())
        stop = clients.subscribe(lambda event: _write(writer, event), replay=True)
        leave = clients.join(request.console) if request.console is not None else None
        try:
            self._followed.set()
            while line := await reader.readline():
                _write(writer, self._reply_to_line(line))
        finally:
            # However the connection ended: a peer that dies with unread events resets it.
            stop()
            if leave is not None:
                leave()

    def _reply_to_line(self, line: bytes) -> Reply:
        try:
            request = _Request.parse(line)
        except json.JSONDecodeError:
            raise  # the stream is out of step: `_accept` closes the connection
        except ValueError as error:
            return {"event": "error", "message": str(error)}
        return self._reply(request)


def _object(data: object) -> dict[str, Any]:
    """Check that data is a JSON object."""
    if not isinstance(data, dict):
        raise TypeError("not a JSON object")
    return data


def _write(writer: asyncio.StreamWriter, event: GraphEvent | Reply) -> None:
    if writer.transport.get_write_buffer_size() > UNREAD_LIMIT:
        writer.transport.abort()
    if not writer.is_closing():
        writer.write(json.dumps(event).encode() + b"\n")


def _peer_uid(connection: socket.socket) -> int | None:
    """Return the user of the process at the other end; None where the system does not report it."""
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
            line_limit: Longest line in bytes.

        Raises:
            OSError: Nothing answers at the address.
        """
        connection, token = connect(address)
        # One asyncio transport for both stops reading when a write fails, losing the supervisor's last events.
        for_writing = connection.dup()
        reader, kept_open = await asyncio.open_connection(sock=connection, limit=line_limit)
        _, writer = await asyncio.open_connection(sock=for_writing)
        writer.transport.pause_reading()  # type: ignore[attr-defined]
        return cls(reader, (writer, kept_open), token)

    def send(self, **request: object) -> bool:
        """Send a request; returns whether the connection was still open."""
        writer = self._writers[0]
        if self._has_ended or writer.is_closing():
            return False
        writer.write(json.dumps({**request, **self._token}).encode() + b"\n")
        return True

    def end_requests(self) -> None:
        """Close the writing end: once it has read all requests, the supervisor closes the connection."""
        self._has_ended = True
        if not self._writers[0].is_closing():
            self._writers[0].write_eof()

    async def receive(self) -> AsyncIterator[dict[str, Any]]:
        """Yield events as they come, until the supervisor closes the connection.

        Raises:
            OSError: The connection broke.
            ValueError: A line is too long, or not JSON.
        """
        while line := await self._reader.readline():
            yield json.loads(line)

    def close(self) -> None:
        for writer in self._writers:
            writer.close()
